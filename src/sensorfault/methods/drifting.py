"""What the tests for a slow drift of a height share: the difference to the barometer, its limits, the monitor."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from sensorfault.logs.table import Log, LogError
from sensorfault.methods.recipe import Recipe
from sensorfault.model import Model, hold_s, owners
from sensorfault.monitor.decision.exceed import Exceed
from sensorfault.monitor.monitor import Branch, Monitor
from sensorfault.monitor.recovery.rebuild import Rebuild
from sensorfault.monitor.residual.difference import Difference
from sensorfault.monitor.statistic.cusum import Cusum
from sensorfault.monitor.statistic.windowed import Measure, Windowed
from sensorfault.monitor.threshold.fixed import Fixed
from sensorfault.numerics.blocks import EARLY
from sensorfault.stage import Stage
from sensorfault.training.difference import fit_difference
from sensorfault.training.session import Session
from sensorfault.training.tapes import score_tape
from sensorfault.vehicles.fixed_wing import roles

GAP_BEATS = 10.0  # without the receiver or the barometer for so long, a window begins anew
REBUILD_S = 300.0  # what the barometer says stands in for so long: its offset wanders over minutes
LEAST_WINDOWS = 1.5  # that a training flight must hold
CEILING = 2.0  # times the limit: a sum goes no higher
PRESUMES = "presumes the barometer healthy"
PROMISE = "none; the limit is a tenth above the largest score of the training flight"

Statistic = Stage[Any, Any, Any, Any]


@dataclass(frozen=True)
class Setting:
    """`window_s`: how long a test looks back. `margin`: on the largest healthy score of the training flight.

    `memory_s`: how slowly the offset of the two heights is followed; inf: it is that of the first ten beats for good.
    `lagging`: whether the lag of one height behind the other is learned. `slots` of a window; 0: one for each beat.
    """

    window_s: float = 130.0
    beat_s: float = 1.0
    margin: float = 1.1
    memory_s: float = np.inf
    lagging: bool = True
    slots: int = 0

    @property
    def gap_s(self) -> Float[Array, ""]:
        """A longer silence empties a window [s]."""
        return jnp.asarray(GAP_BEATS * self.beat_s)

    def windowed(self, measure: Measure, channels: int) -> Windowed:
        """This measure of a window with a block for each beat."""
        slots = self.slots or int(np.ceil((self.window_s / self.beat_s + 2) / (1 - EARLY)))
        return Windowed(measure, jnp.asarray(self.window_s), self.gap_s, channels, slots)


DEFAULT = Setting()
Test = Callable[[Setting, int], Statistic]  # of so many channels


def recipe(name: str, title: str, source: str, test: Test, setting: Setting = DEFAULT) -> Recipe:
    """The recipe of a test."""

    def build(log: Log, seed: int, session: Session) -> Model:
        session.tell("learning how two heights differ when healthy")
        return drift(name, log, test, setting)

    return Recipe(name, f"{title}; {PRESUMES}", source, PROMISE, build)


def drift(name: str, log: Log, test: Test, setting: Setting) -> Model:
    """Fit on a healthy flight: the difference of its two heights, and the limit of `test` of it.

    Raises:
        LogError: not two heights, or too short a flight.
    """
    part = difference(name, log, setting)
    statistic = test(setting, len(log.channels))
    deaf = monitor(log, part, statistic, Fixed(jnp.full(len(log.channels), jnp.inf)), setting)
    heard, limit = limited(deaf, log, part.measured, setting)
    if not np.isfinite(limit):
        raise LogError(
            f"{log.name} is never watched for {setting.window_s:g} s without a break, over which {name} looks back; "
            "give it a longer flight, or one with fewer gaps."
        )
    return _model(name, log, heard, part, limit, setting)


def limited(deaf: Monitor, log: Log, column: int, setting: Setting) -> tuple[Monitor, float]:
    """The monitor with the limit of a healthy log, and that limit; it stays deaf where nothing was tested."""
    score = score_tape(deaf, log)[0][:, column]
    limit = setting.margin * float(np.nanmax(score, initial=-np.inf))
    limit = limit if np.isfinite(limit) else np.inf
    statistic = deaf.branches[0].statistic
    if isinstance(statistic, Cusum):
        statistic = replace(statistic, ceiling=jnp.full_like(statistic.ceiling, CEILING * limit))
    mine = np.arange(len(log.channels)) == column
    parts = (statistic, jnp.asarray(np.where(mine, limit, np.inf)))
    heard: Monitor = eqx.tree_at(lambda m: (m.branches[0].statistic, m.branches[0].threshold.limit), deaf, parts)
    return heard, limit


def difference(name: str, log: Log, setting: Setting) -> Difference:
    """The residual, fitted.

    Raises:
        LogError: not two heights, or too short a flight.
    """
    found = roles(log)
    if found.height is None or found.barometric is None:
        lacks = "no height of a satellite receiver" if found.height is None else "no height of a barometer"
        raise LogError(
            f"{log.name} has {lacks}; {name} compares the two: name the columns in vehicle.toml, or take a method that "
            "needs only one."
        )
    needed = LEAST_WINDOWS * setting.window_s
    if log.duration_s < needed:
        raise LogError(
            f"{log.name} lasts {log.duration_s:.0f} s, {name} needs {needed:.0f} s to learn what is healthy; give it a "
            "longer flight."
        )
    part = Difference(
        beat_s=jnp.asarray(setting.beat_s),
        lag_s=jnp.zeros(()),
        memory_s=jnp.asarray(setting.memory_s),
        gap_s=setting.gap_s,
        variance=jnp.ones(()),
        measured=found.height,
        reference=found.barometric,
        channels=len(log.channels),
    )
    return fit_difference(part, log, setting.lagging)


def monitor(log: Log, part: Difference, statistic: Statistic, threshold: Fixed, setting: Setting) -> Monitor:
    """The height is out while its test is over the limit; the barometer with the learned offset stands in."""
    channels = len(log.channels)
    verdict_s = np.where(np.arange(channels) == part.measured, 1.5 * setting.beat_s, 0.0)
    return Monitor(
        residual=part,
        branches=(Branch(statistic, threshold),),
        decision=Exceed(),
        recovery=Rebuild(jnp.asarray(REBUILD_S), jnp.asarray(1.5 * setting.beat_s), channels),
        hold_s=jnp.asarray(np.maximum(hold_s(log), verdict_s)),
        owner=owners(log.channels, log.sensors),
    )


def _model(name: str, log: Log, heard: Monitor, part: Difference, limit: float, setting: Setting) -> Model:
    mine = np.arange(len(log.channels)) == part.measured
    told = {
        "training_log": log.name,
        "training_s": log.duration_s,
        "reference": log.channels[part.reference].path,
        "lag_s": float(part.lag_s),
        "window_s": setting.window_s,
        "limit": limit,
        "not_watched": {c.path: "not compared" for c, m in zip(log.channels, mine, strict=True) if not m},
    }
    return Model(
        method=name,
        monitor=heard,
        channels=log.channels,
        sensors=log.sensors,
        tests=tuple((name, channel.path) for channel in log.channels),
        watched=tuple(mine.tolist()),
        tick_s=log.period_s,
        sigma=tuple(np.where(mine, np.sqrt(float(part.variance)), 1.0).tolist()),
        summary=told,
    )
