"""What methods that judge a whole sample by one test share: the monitor around the residual, and its two limits."""

from dataclasses import dataclass
from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from sensorfault.calibration.limits import repeat_limit
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.stage import Stage
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.common.watch import watchable
from sensorfault.runtime.model import Model, complete, hold_s, owners
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.rebuild import Rebuild
from sensorfault.stages.statistic.repeats import Repeats
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.stages.threshold.scaled_max import ScaledMax

REBUILD_S = 10.0  # a stand-in is believed for so long
LEAST_ROWS = 50


@dataclass(frozen=True)
class Training:
    """A healthy log as such a method sees it.

    `rows`: those with every watched channel. `reasons`: path -> why a channel is not watched.
    """

    log: Log
    watched: Bool[np.ndarray, " C"]
    rows: Bool[np.ndarray, " T"]
    reasons: dict[str, str]

    @classmethod
    def of(cls, name: str, log: Log, often: float = 0.5) -> "Training":
        """For the method of that name; watched is what comes with at least `often` of the ticks.

        Raises:
            LogError: too few complete rows, or nothing to watch.
        """
        watched, reasons = watchable(log, often)
        rows = complete(log, watched)
        if rows.sum() < LEAST_ROWS:
            raise LogError(
                f"{log.name} has {rows.sum()} rows with every watched channel, {name} needs {LEAST_ROWS}; "
                "give it more data, or watch fewer channels."
            )
        return cls(log, watched, rows, reasons)


def uncalibrated(
    log: Log, residual: Stage[Any, Any, Any, Any], statistic: Stage[Any, Any, Any, Any], readmit_s: float
) -> Monitor:
    """The monitor with its limits off: a joint test of the sample and one of exact repeats a channel.

    A channel is taken at its own word again `readmit_s` after the last accusation.
    """
    channels = len(log.channels)
    return Monitor(
        residual=residual,
        branches=(
            Branch(statistic, ScaledMax(jnp.full(1, jnp.inf))),
            Branch(Repeats(channels), Fixed(jnp.full(channels, jnp.inf)), certain=True),
        ),
        decision=Exceed(share=1.0),
        recovery=Rebuild(jnp.asarray(REBUILD_S), jnp.asarray(readmit_s), channels),
        hold_s=jnp.asarray(hold_s(log)),
        owner=owners(log.channels, log.sensors),
        most=1,
        together=False,
    )


def limited(
    name: str,
    training: Training,
    monitor: Monitor,
    cov: Float[Array, "C C"],
    test: str,
    largest: float,
    runs: Float[np.ndarray, "T C"],
) -> Model:
    """The model: `cov` of the healthy residual, the joint `test`'s largest healthy score, the tape of the repeats."""
    log = training.log
    calibrated = eqx.tree_at(
        lambda m: (m.branches[0].threshold.largest, m.branches[1].threshold.limit),
        monitor,
        (jnp.full(1, largest), jnp.asarray(repeat_limit(runs, log.period_s))),
    )
    tests = ((test, None), *(("repeats", channel.path) for channel in log.channels))
    result = {
        "training_log": log.name,
        "training_s": log.duration_s,
        "rows": int(training.rows.sum()),
        "not_watched": training.reasons,
    }
    sigma = tuple(np.sqrt(np.diag(np.asarray(cov))).tolist())
    watched = tuple(training.watched.tolist())
    return Model(name, calibrated, log.channels, log.sensors, tests, watched, log.period_s, sigma, result)
