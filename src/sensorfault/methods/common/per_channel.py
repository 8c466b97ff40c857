"""Shared by methods that test each channel on its own: the monitor, and its limits."""

from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.calibration.limits import tail_limit
from sensorfault.calibration.open_loop import open_loop
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.stage import Stage
from sensorfault.logs.rates import hold_s
from sensorfault.logs.table import Log
from sensorfault.runtime.model import Model, owners
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.rebuild import Rebuild
from sensorfault.stages.statistic.absolute import Absolute
from sensorfault.stages.statistic.relative import Relative
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.stages.threshold.sigma import Sigma

PER_HOUR = 1.0  # false alarms an hour that the limits are set for, all channels together
BLOCK = 50  # ticks; alarms within one block count once
HORIZON = 10  # a stand-in is used for at most so many ticks

Statistic = Absolute | Relative
SIZE: Statistic = Absolute()


def monitor(
    log: Log,
    residual: Stage[Any, Any, Any, Any],
    threshold: Fixed | Sigma,
    horizon: int = HORIZON,
    statistic: Statistic = SIZE,
) -> Monitor:
    """One limit for each channel; every channel over its limit is named and excluded for that sample."""
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
    """Limits that healthy data exceed PER_HOUR times an hour over all channels, and each residual's RMS [SI].

    A channel without a residual has limit +inf and RMS 1.
    """
    channels = len(log.channels)
    uncalibrated = monitor(log, residual, Fixed(jnp.full(channels, jnp.inf)), statistic=statistic)
    tape = open_loop(uncalibrated, log)
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
    extra: dict[str, Any],
    horizon: int = HORIZON,
    statistic: Statistic = SIZE,
) -> Model:
    """The model with these limits; a channel with an infinite limit is not watched. `extra` goes into the summary."""
    paths = [channel.path for channel in log.channels]
    test = "absolute" if isinstance(statistic, Absolute) else "absolute, relative"
    tests = tuple((test, path) for path in paths)
    limits = np.asarray(threshold.limit() if isinstance(threshold, Sigma) else threshold.limit)
    watched = tuple(np.isfinite(limits).tolist())
    finite = {path: float(limit) for path, limit in zip(paths, limits, strict=True) if np.isfinite(limit)}
    summary = {"training_log": log.name, "training_s": log.duration_s, "limits": finite, **extra}
    own = monitor(log, residual, threshold, horizon, statistic)
    return Model(name, own, log.channels, log.sensors, tests, watched, log.period_s, tuple(spread.tolist()), summary)
