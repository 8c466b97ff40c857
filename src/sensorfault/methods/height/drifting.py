"""Shared by the tests for slow drift of a height: the difference to the barometer, its limits, the monitor."""

from dataclasses import replace

import jax.numpy as jnp
import numpy as np

from sensorfault.calibration.open_loop import open_loop_scores
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.logs.rates import hold_s
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.height.drift_setting import DriftTest, Setting, Statistic
from sensorfault.methods.height.needs import two_heights
from sensorfault.runtime.model import Model, owners
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.rebuild import Rebuild
from sensorfault.stages.residual.difference import Difference
from sensorfault.stages.statistic.absolute import Absolute
from sensorfault.stages.statistic.cusum import Cusum
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.difference import fit_difference
from sensorfault.training.session import Session

REBUILD_S = 300.0  # the barometer is a stand-in for at most this long: its offset changes over minutes [s]
LEAST_WINDOWS = 1.5  # a training flight must be this many windows long
LEVEL = 2.0  # limit over the largest healthy difference; finds a drift that has stopped, which the other test misses
CEILING = 1.25  # a cumulative sum stops at this many times its limit


def build(test: DriftTest, log: Log, seed: int, session: Session) -> Model:
    """Fit on a healthy flight.

    Raises:
        LogError: the log lacks one of the two heights, or the flight is too short.
    """
    session.progress("measuring how the two heights differ when healthy")
    return drift(log, test)


def drift(log: Log, test: DriftTest) -> Model:
    """Fit on a healthy flight: the difference of its two heights, and the limits of the tests.

    Raises:
        LogError: the log lacks one of the two heights, or the flight is too short.
    """
    setting, channels = test.setting, len(log.channels)
    part = difference(test.name, log, setting)
    statistic = test.statistic(setting, channels)
    off = Fixed(jnp.full(channels, jnp.inf))
    uncalibrated = monitor(log, part, statistic, off, setting, off)
    score, level = (tape[:, part.measured] for tape in open_loop_scores(uncalibrated, log))
    if not np.isfinite(score).any():
        raise LogError(
            f"{log.name} has no stretch of {setting.window_s:g} s without a gap, which {test.name} needs; give it a "
            "longer flight, or one with fewer gaps."
        )
    limit = setting.margin * float(np.nanmax(score))
    if isinstance(statistic, Cusum):
        statistic = replace(statistic, ceiling=jnp.full_like(statistic.ceiling, CEILING * limit))
    largest = LEVEL * float(np.nanmax(level))
    own, lasting = (
        Fixed(jnp.asarray(np.where(np.arange(channels) == part.measured, x, np.inf))) for x in (limit, largest)
    )
    calibrated = monitor(log, part, statistic, own, setting, lasting)
    return _model(test.name, log, calibrated, part, {"limit": limit, "level": largest}, setting)


def difference(name: str, log: Log, setting: Setting) -> Difference:
    """The residual, fitted.

    Raises:
        LogError: the log lacks one of the two heights, or the flight is too short.
    """
    needed = LEAST_WINDOWS * setting.window_s
    measured, reference = two_heights(name, log)
    if log.duration_s < needed:
        raise LogError(
            f"{log.name} lasts {log.duration_s:.0f} s, but {name} needs {needed:.0f} s to learn what is healthy; give "
            "a longer flight."
        )
    part = Difference(
        beat_s=jnp.asarray(setting.beat_s),
        lag_s=jnp.zeros(()),
        memory_s=jnp.asarray(setting.memory_s),
        gap_s=setting.gap_s,
        variance=jnp.ones(()),
        measured=measured,
        reference=reference,
        channels=len(log.channels),
    )
    return fit_difference(part, log, setting.lagging)


def monitor(
    log: Log,
    part: Difference,
    statistic: Statistic,
    threshold: Fixed,
    setting: Setting,
    level: Fixed | None = None,
) -> Monitor:
    """The height is excluded while its test is over the limit, or the difference itself over its limit `level`.

    The stand-in is the barometer plus the learned offset.
    """
    channels = len(log.channels)
    verdict_s = np.where(np.arange(channels) == part.measured, 1.5 * setting.beat_s, 0.0)
    return Monitor(
        residual=part,
        branches=(Branch(statistic, threshold), *(() if level is None else (Branch(Absolute(), level),))),
        decision=Exceed(),
        recovery=Rebuild(jnp.asarray(REBUILD_S), jnp.asarray(1.5 * setting.beat_s), channels),
        hold_s=jnp.asarray(np.maximum(hold_s(log), verdict_s)),
        owner=owners(log.channels, log.sensors),
    )


def _model(
    name: str, log: Log, calibrated: Monitor, part: Difference, limits: dict[str, float], setting: Setting
) -> Model:
    mine = np.arange(len(log.channels)) == part.measured
    summary = {
        "training_log": log.name,
        "training_s": log.duration_s,
        "reference": log.channels[part.reference].path,
        "lag_s": float(part.lag_s),
        "window_s": setting.window_s,
        **limits,
        "not_watched": {c.path: "not compared" for c, m in zip(log.channels, mine, strict=True) if not m},
    }
    return Model(
        method=name,
        monitor=calibrated,
        channels=log.channels,
        sensors=log.sensors,
        tests=tuple((test, channel.path) for test in (name, "level") for channel in log.channels),
        watched=tuple(mine.tolist()),
        tick_s=log.period_s,
        sigma=tuple(np.where(mine, np.sqrt(float(part.variance)), 1.0).tolist()),
        summary=summary,
    )
