"""Several fitted methods as one monitor, under one false alarm budget."""

from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Bool, Float

from sensorfault.calibration.limits import tail_limit
from sensorfault.calibration.open_loop import open_loop_scores
from sensorfault.core.monitor import Monitor
from sensorfault.core.stage import Stage
from sensorfault.logs.rates import hold_s
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model, owners
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.rebuild import Rebuild
from sensorfault.stages.residual.several import Several
from sensorfault.stages.statistic.select_residual import SelectResidual
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.stages.threshold.scaled_max import ScaledMax
from sensorfault.training.session import Session

MOST = 2  # sensors excluded at one sample, at most


def composite(
    name: str,
    log: Log,
    parts: Sequence[Recipe],
    per_hour: float,
    seed: int,
    session: Session,
    kept: Collection[str] = (),
) -> Model:
    """Fit every part that the log allows; a channel that several parts watch is judged by the first of them.

    The limits of each part alone are set for `per_hour` false alarms. In the composite each test gets an equal share of
    these, so its limit is raised according to the tail of its scores on this log. Two kinds of test keep their own
    limits: exact repeats, whose rate is far smaller, and the parts named in `kept`, because a log of minutes does not
    show the tail of a test with a memory of a minute. `summary["cannot"]` says why a part could not be fitted.

    Raises:
        LogError: no part can be fitted on this log.
    """
    models: list[Model] = []
    cannot: dict[str, str] = {}
    for recipe in parts:
        session.progress(f"fitting {recipe.name}")
        try:
            model = recipe.build(log, seed, session)
            cannot |= model.summary.get("cannot", {})
            models.append(model)
        except LogError as error:
            cannot[recipe.name] = str(error)
    if not models:
        raise LogError(" ".join(cannot.values()))
    session.progress("sharing the false alarm budget")
    limits = _limits(models, log, per_hour, kept)
    first = _judged_first(models)
    part = np.argmax(first, axis=0)  # the part that judges each channel
    sigma = tuple(models[p].sigma[c] for c, p in enumerate(part))
    watched = first[part, np.arange(len(part))]
    reasons = {
        path: reason
        for model in models
        for path, reason in model.summary.get("not_watched", {}).items()
        if not watched[log.index(path)]
    }
    summary: dict[str, Any] = {
        "training_log": log.name,
        "training_s": log.duration_s,
        "not_watched": reasons,
        "parts": [model.method for model in models],
        "cannot": cannot,
        "promised_per_hour": per_hour,
    }
    tests = tuple(test for model in models for test in model.tests)
    monitor = _joined(log, models, limits)
    return Model(name, monitor, log.channels, log.sensors, tests, tuple(watched.tolist()), log.period_s, sigma, summary)


def _judged_first(models: Sequence[Model]) -> Bool[np.ndarray, "P C"]:
    """Which part judges which channel: the first that watches it and tests sensors, not the vehicle's motion."""
    of_sensors = [any(branch.subject == "sensor" for branch in model.monitor.branches) for model in models]
    watched = np.array([model.watched for model in models]) & np.array(of_sensors)[:, None]
    first: Bool[np.ndarray, "P C"] = watched & (np.cumsum(watched, axis=0) == 1)
    return first


def _joined(log: Log, models: Sequence[Model], limits: Sequence[Stage[Any, Any, Any, Any]]) -> Monitor:
    """One monitor with the residuals of all parts and all their branches, with these thresholds."""
    first = _judged_first(models)
    channels = len(log.channels)
    branches = [
        replace(branch, statistic=SelectResidual(branch.statistic, part))
        for part, model in enumerate(models)
        for branch in model.monitor.branches
    ]
    horizon_s, readmit_s = jnp.zeros(channels), jnp.zeros(channels)
    for mine, model in zip(first, models, strict=True):
        if isinstance(recovery := model.monitor.recovery, Rebuild):
            horizon_s = jnp.where(mine, recovery.horizon_s, horizon_s)
            readmit_s = jnp.where(mine, recovery.readmit_s, readmit_s)
    return Monitor(
        residual=Several(tuple(model.monitor.residual for model in models), jnp.asarray(first)),
        branches=tuple(replace(branch, threshold=limit) for branch, limit in zip(branches, limits, strict=True)),
        decision=Exceed(share=1.0),
        recovery=Rebuild(horizon_s, readmit_s, channels),
        hold_s=jnp.asarray(hold_s(log)),
        owner=owners(log.channels, log.sensors),
        most=MOST,
        together=False,
    )


def _limits(
    models: Sequence[Model], log: Log, per_hour: float, kept: Collection[str]
) -> list[Stage[Any, Any, Any, Any]]:
    """Each part's own limit, raised for the smaller share of false alarms; the kept ones unchanged."""
    owns = [branch.threshold for model in models for branch in model.monitor.branches]
    kept_as_is = [branch.certain or model.method in kept for model in models for branch in model.monitor.branches]
    limits: list[Stage[Any, Any, Any, Any]] = []
    for own, as_is, tape in zip(owns, kept_as_is, open_loop_scores(_joined(log, models, owns), log), strict=True):
        share = per_hour / (tape.shape[1] * (len(kept_as_is) - sum(kept_as_is)))
        alone, shared = (tail_limit(tape, log.period_s, rate) for rate in (per_hour, share))
        scaled = (alone > 0) & np.isfinite(shared)
        raised = np.divide(shared, alone, out=np.ones_like(alone), where=scaled)
        limits.append(own if as_is else Fixed(jnp.asarray(_fixed(own) * raised)))
    return limits


def _fixed(threshold: Stage[Any, Any, Any, Any]) -> Float[np.ndarray, " K"]:
    """The limit of a part as a fixed number."""
    if isinstance(threshold, ScaledMax):
        return np.asarray(threshold.fixed_point())
    assert isinstance(threshold, Fixed)
    return np.asarray(threshold.limit)
