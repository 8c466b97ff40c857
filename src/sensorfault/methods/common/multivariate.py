"""Shared by methods with one multivariate test of the whole sample: the monitor, and its two limits."""

from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from sensorfault.calibration.limits import repeat_limit
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.stage import Stage
from sensorfault.logs.rates import hold_s
from sensorfault.logs.table import Log
from sensorfault.methods.common.rows import Training
from sensorfault.runtime.model import Model, owners
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.rebuild import Rebuild
from sensorfault.stages.statistic.repeats import Repeats
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.stages.threshold.scaled_max import ScaledMax

REBUILD_S = 10.0  # a stand-in is used for at most this long [s]


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
