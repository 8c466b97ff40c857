"""Several fitted methods as one monitor, under one budget of false alarms."""

from collections.abc import Collection, Sequence
from dataclasses import replace
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Bool, Float

from sensorfault.calibration.limits import tail_limit
from sensorfault.calibration.open_loop import open_loop_scores, uncalibrated
from sensorfault.core.monitor import Monitor
from sensorfault.core.stage import Stage
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model, hold_s, owners
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.rebuild import Rebuild
from sensorfault.stages.residual.several import Several
from sensorfault.stages.statistic.select_residual import SelectResidual
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.stages.threshold.scaled_max import ScaledMax
from sensorfault.training.session import Session

MOST = 2  # sensors that one sample may exclude


def together(
    name: str,
    log: Log,
    parts: Sequence[Recipe],
    per_hour: float,
    seed: int,
    session: Session,
    kept: Collection[str] = (),
) -> Model:
    """Every part that the log allows, each answering for the channels it watches, the first of several before others.

    Each part comes with limits that promise `per_hour` false alarms if it is alone. Here each of its tests has an equal
    share of that, so its limit is raised by what the share costs in the tail of its scores on this log. Tests of exact
    repeats keep their own limits, which promise far less, and so do the parts whose names are in `kept`: a log of
    minutes shows no tail of what has a memory of a minute. What a part said why it cannot run is in
    `summary["cannot"]`.

    Raises:
        LogError: no part can be fitted on this log.
    """
    models: list[Model] = []
    cannot: dict[str, str] = {}
    for recipe in parts:
        session.tell(f"fitting {recipe.name}")
        try:
            model = recipe.build(log, seed, session)
            cannot |= model.summary.get("cannot", {})
            models.append(model)
        except LogError as error:
            cannot[recipe.name] = str(error)
    if not models:
        raise LogError(" ".join(cannot.values()))
    session.tell("sharing out the false alarms")
    limits = _limits(models, log, per_hour, kept)
    first = _answering(models)
    of = np.argmax(first, axis=0)  # the part that answers for each channel
    sigma = tuple(models[p].sigma[c] for c, p in enumerate(of))
    watched = first[of, np.arange(len(of))]
    reasons = {
        path: reason
        for model in models
        for path, reason in model.summary.get("not_watched", {}).items()
        if not watched[log.index(path)]
    }
    result: dict[str, Any] = {
        "training_log": log.name,
        "training_s": log.duration_s,
        "not_watched": reasons,
        "parts": [model.method for model in models],
        "cannot": cannot,
        "promised_per_hour": per_hour,
    }
    tests = tuple(test for model in models for test in model.tests)
    monitor = _joined(log, models, limits)
    return Model(name, monitor, log.channels, log.sensors, tests, tuple(watched.tolist()), log.period_s, sigma, result)


def _answering(models: Sequence[Model]) -> Bool[np.ndarray, "P C"]:
    """Which part answers for which channel: of those that judge it, not the vehicle's motion, the first."""
    judging = [any(branch.subject == "sensor" for branch in model.monitor.branches) for model in models]
    watched = np.array([model.watched for model in models]) & np.array(judging)[:, None]
    first: Bool[np.ndarray, "P C"] = watched & (np.cumsum(watched, axis=0) == 1)
    return first


def _joined(log: Log, models: Sequence[Model], limits: Sequence[Stage[Any, Any, Any, Any]]) -> Monitor:
    """The parts' residuals side by side, and all their branches, with these thresholds."""
    first = _answering(models)
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
    """Each part's own limit, raised by what the smaller share costs, but for those that are kept."""
    owns = [branch.threshold for model in models for branch in model.monitor.branches]
    stands = [branch.certain or model.method in kept for model in models for branch in model.monitor.branches]
    limits: list[Stage[Any, Any, Any, Any]] = []
    for own, stays, tape in zip(
        owns, stands, open_loop_scores(uncalibrated(_joined(log, models, owns)), log), strict=True
    ):
        share = per_hour / (tape.shape[1] * (len(stands) - sum(stands)))
        alone, shared = (tail_limit(tape, log.period_s, rate) for rate in (per_hour, share))
        scaled = (alone > 0) & np.isfinite(shared)
        dearer = np.divide(shared, alone, out=np.ones_like(alone), where=scaled)
        limits.append(own if stays else Fixed(jnp.asarray(_fixed(own) * dearer)))
    return limits


def _fixed(threshold: Stage[Any, Any, Any, Any]) -> Float[np.ndarray, " K"]:
    """The fixed limit that a part came with."""
    if isinstance(threshold, ScaledMax):
        return np.asarray(threshold.fixed_point())
    assert isinstance(threshold, Fixed)
    return np.asarray(threshold.limit)
