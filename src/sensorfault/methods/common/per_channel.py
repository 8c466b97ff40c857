"""What methods that judge each channel by itself share: the monitor around the residual, and its limits."""

from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.calibration.limits import tail_limit
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.stage import Stage
from sensorfault.logs.table import Log
from sensorfault.runtime.model import Model, hold_s, owners
from sensorfault.runtime.replay import replay_log
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.rebuild import Rebuild
from sensorfault.stages.statistic.absolute import Absolute
from sensorfault.stages.statistic.relative import Relative
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.stages.threshold.sigma import Sigma

PER_HOUR = 1.0  # false alarms promised, of all channels together
BLOCK = 50  # ticks: alarms in one block count once
HORIZON = 10  # ticks for which a stand-in is believed

Statistic = Absolute | Relative
SIZE: Statistic = Absolute()


def monitor(
    log: Log,
    residual: Stage[Any, Any, Any, Any],
    threshold: Fixed | Sigma,
    horizon: int = HORIZON,
    statistic: Statistic = SIZE,
) -> Monitor:
    """One limit a channel; all that are over theirs are named at once, and out for that sample."""
    channels = len(log.channels)
    return Monitor(
        residual=residual,
        branches=(Branch(statistic, threshold),),
        decision=Exceed(),
        recovery=Rebuild(jnp.asarray(horizon * log.period_s), jnp.asarray(log.period_s / 2), channels),
        hold_s=jnp.asarray(hold_s(log)),
        owner=owners(log.channels, log.sensors),
    )


def healthy(
    log: Log, residual: Stage[Any, Any, Any, Any], statistic: Statistic = SIZE
) -> tuple[Float[np.ndarray, " C"], Float[np.ndarray, " C"]]:
    """Limits that a healthy log passes PER_HOUR times an hour in all, +inf for a channel without a residual; and the
    root mean square of each channel's residual [SI], 1 where there is none.
    """
    channels = len(log.channels)
    uncalibrated = monitor(log, residual, Fixed(jnp.full(channels, jnp.inf)), statistic=statistic)
    tape = replay_log(uncalibrated, log)
    score, valid = np.asarray(tape.scores[0]), np.asarray(tape.valid)
    square = np.where(valid, np.asarray(tape.residual) ** 2, 0.0).sum(axis=0) / np.maximum(valid.sum(axis=0), 1)
    spread = np.where(valid.any(axis=0), np.sqrt(square), 1.0)
    return tail_limit(score, log.period_s, PER_HOUR / channels, BLOCK * log.period_s), spread


def model(
    name: str,
    log: Log,
    residual: Stage[Any, Any, Any, Any],
    threshold: Fixed | Sigma,
    spread: Float[np.ndarray, " C"],
    result: dict[str, Any],
    horizon: int = HORIZON,
    statistic: Statistic = SIZE,
) -> Model:
    """The model with these limits; a channel whose limit is infinite is not watched."""
    paths = [channel.path for channel in log.channels]
    test = "absolute" if isinstance(statistic, Absolute) else "absolute, relative"
    tests = tuple((test, path) for path in paths)
    limits = np.asarray(threshold.limit() if isinstance(threshold, Sigma) else threshold.limit)
    watched = tuple(np.isfinite(limits).tolist())
    finite = {path: float(limit) for path, limit in zip(paths, limits, strict=True) if np.isfinite(limit)}
    result = {"training_log": log.name, "training_s": log.duration_s, "limits": finite, **result}
    own = monitor(log, residual, threshold, horizon, statistic)
    return Model(name, own, log.channels, log.sensors, tests, watched, log.period_s, tuple(spread.tolist()), result)
