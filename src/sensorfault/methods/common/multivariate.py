"""Shared by methods with one multivariate test of the whole sample: the monitor, and its two limits."""

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

REBUILD_S = 10.0  # a stand-in is used for at most this long [s]
LEAST_ROWS = 50


@dataclass(frozen=True)
class Training:
    """A healthy log, its watched channels, and the rows that have all of them.

    `reasons`: path of each channel that is not watched -> why.
    """

    log: Log
    watched: Bool[np.ndarray, " C"]
    rows: Bool[np.ndarray, " T"]
    reasons: dict[str, str]

    @classmethod
    def of(cls, name: str, log: Log, often: float = 0.5) -> "Training":
        """For the method called `name`; watched are channels with a value in at least the share `often` of the ticks.

        Raises:
            LogError: too few complete rows, or no channel to watch.
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
    """The monitor with its limits off: a multivariate test of the sample and an exact-repeat test of each channel.

    A channel is trusted again `readmit_s` after its last alarm.
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
    """The model: `cov` of the healthy residual, `largest` healthy score of `test`, healthy `runs` of exact repeats."""
    log = training.log
    calibrated = eqx.tree_at(
        lambda m: (m.branches[0].threshold.largest, m.branches[1].threshold.limit),
        monitor,
        (jnp.full(1, largest), jnp.asarray(repeat_limit(runs, log.period_s))),
    )
    tests = ((test, None), *(("repeats", channel.path) for channel in log.channels))
    summary = {
        "training_log": log.name,
        "training_s": log.duration_s,
        "rows": int(training.rows.sum()),
        "not_watched": training.reasons,
    }
    sigma = tuple(np.sqrt(np.diag(np.asarray(cov))).tolist())
    watched = tuple(training.watched.tolist())
    return Model(name, calibrated, log.channels, log.sensors, tests, watched, log.period_s, sigma, summary)
