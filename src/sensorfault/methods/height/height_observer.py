"""Shared by both observers of a height: the height's column, the error of a roll-out, and the monitor."""

from collections.abc import Mapping, Sequence
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.stage import Stage
from sensorfault.logs.rates import hold_s
from sensorfault.logs.table import Log
from sensorfault.methods.height.heights import Heights
from sensorfault.runtime.model import Model, owners
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.rebuild import Rebuild
from sensorfault.stages.residual.multistep_observer import MultistepObserver
from sensorfault.stages.threshold.adaptive import Adaptive
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.fixes import Fixes
from sensorfault.training.roll_out import errors
from sensorfault.vehicles.height import Climb, StepNetwork

PER_HOUR = 1.0  # false alarms an hour that the limits are set for
BLOCK_S = 10.0  # alarms within this time count once [s]
LEAST_WINDOWS = 20
AGES = (1, 2, 5, 12, 25, 50, 100)  # the error of a roll-out is measured after these steps


def observer(model: Climb | StepNetwork, fixes: Fixes, steps: tuple[int, ...], column: int) -> MultistepObserver:
    """The residual for these numbers of steps; its variance as a function of age is measured on `fixes`."""
    ages = [n for n in AGES if len(fixes.windows(n)) >= LEAST_WINDOWS] or [1]
    spread = np.mean(errors(model, fixes, ages) ** 2, axis=1)
    return MultistepObserver(
        model=model,
        steps=jnp.asarray(steps),
        ages=jnp.asarray(np.array(ages) * fixes.period_s),
        variance=jnp.asarray(np.maximum.accumulate(np.maximum(spread, 1e-9))),
        gap_s=jnp.asarray(fixes.gap_s),
        column=column,
        longest=max(steps),
    )


def monitor(
    log: Log,
    residual: Stage[Any, Any, Any, Any],
    statistic: Stage[Any, Any, Any, Any],
    threshold: Adaptive | Fixed,
    horizon_s: float,
    period_s: float,
) -> Monitor:
    """A height over any limit is excluded for that sample; the roll-out is its stand-in for at most `horizon_s`."""
    channels = len(log.channels)
    return Monitor(
        residual=residual,
        branches=(Branch(statistic, threshold),),
        decision=Exceed(),
        recovery=Rebuild(jnp.asarray(horizon_s), jnp.asarray(1.5 * period_s), channels),
        hold_s=jnp.asarray(hold_s(log)),
        owner=owners(log.channels, log.sensors),
    )


def model(
    name: str,
    heights: Heights,
    calibrated: Monitor,
    residual: MultistepObserver,
    period_s: float,
    extra: Mapping[str, Any],
) -> Model:
    """The model, with one test for each number of steps; `extra` goes into the summary."""
    log, path = heights.log, heights.log.channels[heights.column].path
    mine = np.arange(len(log.channels)) == heights.column
    sigma = np.where(mine, np.sqrt(float(residual.variance[0])), 1.0)
    tests = tuple((f"roll-out over {n * period_s:.3g} s", path) for n in np.asarray(residual.steps).tolist())
    summary = {
        "training_log": log.name,
        "training_s": log.duration_s,
        "steps": np.asarray(residual.steps).tolist(),
        "inputs": [log.channels[i].path for i in residual.model.columns],
        "not_watched": {c.path: "not predicted" for c, m in zip(log.channels, mine, strict=True) if not m},
        **extra,
    }
    return Model(
        name,
        calibrated,
        log.channels,
        log.sensors,
        tests,
        tuple(mine.tolist()),
        log.period_s,
        tuple(sigma.tolist()),
        summary,
    )


def in_steps(spans_s: Sequence[float], fixes: Fixes) -> tuple[int, ...]:
    """Spans of time as numbers of steps, at least one; in rising order."""
    return tuple(sorted({max(round(span / fixes.period_s), 1) for span in spans_s}))


def silent(tests: int) -> Float[Array, " K"]:
    """Limits that nothing exceeds."""
    return jnp.full(tests, jnp.inf)
