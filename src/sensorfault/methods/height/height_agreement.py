"""Do the heights agree: receiver, barometer and vertical speeds, each two against each other over a minute."""

from itertools import combinations

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.core.monitor import Branch, Monitor
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.recipe import Recipe
from sensorfault.numerics.pairwise_difference import PAST, RECENT
from sensorfault.runtime.model import TOGETHER, Model, hold_s, owners
from sensorfault.runtime.replay import replay_log
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.rebuild import Rebuild
from sensorfault.stages.residual.two_heights import TwoHeights
from sensorfault.stages.statistic.agreement import Agreement
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.session import Session
from sensorfault.vehicles.fixed_wing import Roles, roles

BEAT_S = 1.0
GAP_S = 3.0  # or three periods of the receiver
MEMORY_S = 60.0  # over which the difference of two heights is learned
AFRESH_S = 300.0  # a longer disagreement is taken for a witness set anew
REBUILD_S = 120.0  # a height is believed for so long on another's word
READMIT_S = 2.0
MARGIN = 1.5  # on every limit, for what a flight of minutes has not shown
FREE_M = 1e6  # a limit under which nobody is suspected
FINEST_M = np.array([1.5, 3.0])  # of a jump and of a drift: healthy heights move apart by so much on any flight
LEAST_S = 60.0  # that can be compared, after the minute that fills the memory


def build(log: Log, seed: int, session: Session) -> Model:
    """Fit on a healthy flight; there is no chance in it.

    Raises:
        LogError: fewer than two witnesses of the height, or too short a flight.
    """
    found = roles(log)
    witnesses = _witnesses(log, found)
    columns, pairs = tuple(witnesses), tuple(combinations(range(len(witnesses)), 2))
    free = Agreement(
        limit=jnp.full((2, len(pairs)), FREE_M),
        upward=jnp.asarray(list(witnesses.values())),
        beat_s=jnp.asarray(BEAT_S),
        gap_s=jnp.asarray(max(GAP_S, 3 * _period_s(log, columns[0]))),
        afresh_s=jnp.asarray(AFRESH_S),
        columns=columns,
        pairs=pairs,
        owner=_sources(log, found),
    )
    residual = TwoHeights(
        memory_s=jnp.asarray(MEMORY_S),
        variance=jnp.asarray(1.0),
        heights=tuple(c for c, upward in witnesses.items() if upward == 0),
        watched=columns,
        channels=len(log.channels),
    )
    session.tell("measuring how far healthy heights move apart")
    limit = _limit(log, residual, free)
    # of the first two witnesses, which are the heights if there are two
    variance = (limit[0, 0] / 3) ** 2 if np.isfinite(limit[0, 0]) else 1.0
    residual = eqx.tree_at(lambda r: r.variance, residual, jnp.asarray(variance))
    agreement = eqx.tree_at(lambda s: s.limit, free, jnp.asarray(limit))
    paths = [log.channels[c].path for c in columns]
    names = [TOGETHER.join((paths[i], paths[j])) for i, j in pairs]
    spans = [f"apart within {length * BEAT_S:g} s" for length in (RECENT, RECENT + PAST)]
    result = {
        "training_log": log.name,
        "training_s": log.duration_s,
        "limits": {s: dict(zip(names, row.tolist(), strict=True)) for s, row in zip(spans, limit, strict=True)},
        "smallest_drift": dict(zip(names, (limit[-1] / ((RECENT + PAST) * BEAT_S)).tolist(), strict=True)),
        "not_watched": {c.path: "not of the height" for c in log.channels if c.path not in paths},
    }
    sigma = np.where(np.isin(np.arange(len(log.channels)), residual.heights), np.sqrt(variance), 1.0)
    return Model(
        method=NAME,
        monitor=_monitor(log, residual, agreement, 1.0),
        channels=log.channels,
        sensors=log.sensors,
        tests=tuple((span, name) for span in spans for name in names),
        watched=tuple(np.isin(np.arange(len(log.channels)), columns).tolist()),
        tick_s=log.period_s,
        sigma=tuple(sigma.tolist()),
        summary=result,
    )


def _limit(log: Log, residual: TwoHeights, free: Agreement) -> Float[np.ndarray, "2 P"]:
    """A margin above the farthest that each pair was apart; +inf for one that could never be compared.

    Raises:
        LogError: too few could.
    """
    score = np.asarray(replay_log(_monitor(log, residual, free, np.inf), log).scores[0])
    tested = np.isfinite(score)
    if tested[:, len(free.pairs) :].any(axis=1).sum() * log.period_s < LEAST_S:
        raise LogError(
            f"{log.name} is {log.duration_s:.0f} s long, {NAME} needs {2 * LEAST_S:g} s of heights without a gap: one "
            "minute to remember and one to compare; give a longer flight."
        )
    largest = (FREE_M * np.where(tested, score, 0.0).max(axis=0)).reshape(free.limit.shape)
    known = tested.any(axis=0).reshape(free.limit.shape)
    return np.where(known, MARGIN * np.maximum(largest, FINEST_M[:, None]), np.inf)


def _witnesses(log: Log, found: Roles) -> dict[int, float]:
    """Columns and signs of what says something of the height, the receiver's (or whoever else's) height first.

    Raises:
        LogError: fewer than two.
    """
    heights = [(c, 0.0) for c in (found.height, found.barometric) if c is not None]
    speeds = [(found.vertical, found.upward), (found.inertial, found.inertial_upward)]
    witnesses = dict([*heights, *((c, sign) for c, sign in speeds if c is not None)])
    if not heights or len(witnesses) < 2:
        raise LogError(
            f"{log.name} has {len(witnesses)} channels that tell its height (altitude [m], vertical speed [m/s]), "
            f"{NAME} compares at least two, one of them an altitude; name the columns in vehicle.toml, or take another "
            "method."
        )
    return witnesses


def _sources(log: Log, found: Roles) -> tuple[int, ...]:
    """Who may be wrong together: the channels of a sensor, and the receiver's height and vertical speed even where the
    log has them as two sensors.
    """
    source = list(owners(log.channels, log.sensors))
    if found.height is not None and found.vertical is not None:
        source = [source[found.height] if s == source[found.vertical] else s for s in source]
    return tuple(source)


def _monitor(log: Log, residual: TwoHeights, agreement: Agreement, limit: float) -> Monitor:
    """Alarm where a pair is so many times its limit apart. A vertical speed has no stand-in."""
    channels = len(log.channels)
    stands_in = np.isin(np.arange(channels), residual.heights) & (len(residual.heights) == 2)
    return Monitor(
        residual=residual,
        branches=(Branch(agreement, Fixed(jnp.full(agreement.limit.size, limit))),),
        decision=Exceed(share=1.0),
        recovery=Rebuild(jnp.asarray(np.where(stands_in, REBUILD_S, 0.0)), jnp.full(channels, READMIT_S), channels),
        hold_s=jnp.asarray(hold_s(log)),
        owner=owners(log.channels, log.sensors),
        together=False,
    )


def _period_s(log: Log, column: int) -> float:
    return next(s.period_s for s in log.sensors if s.name == log.channels[column].sensor)


NAME = "height-agreement"
RECIPE = Recipe(
    name=NAME,
    title="Receiver, barometer and vertical speeds against each other over a minute; who lies, if a third one knows",
    source="mean pair against an independent reference, EXPERIMENTS multistep; isolation by who disagrees with whom",
    promise="none; limits are half as high again as the largest of the healthy flight: a flight of minutes shows no "
    "rate of what has a memory of a minute",
    build=build,
    needs=lambda log: _witnesses(log, roles(log)),
)
