"""Do the heights agree? Receiver, barometer and vertical speeds, compared in pairs over a minute."""

from itertools import combinations

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.calibration.open_loop import open_loop_scores
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.logs.rates import hold_s
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.height.needs import height_sources
from sensorfault.methods.recipe import Recipe
from sensorfault.numerics.pairwise_difference import PAST, RECENT
from sensorfault.runtime.model import TOGETHER, Model, owners
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.rebuild import Rebuild
from sensorfault.stages.residual.two_heights import TwoHeights
from sensorfault.stages.statistic.agreement import Agreement
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.session import Session
from sensorfault.vehicles.fixed_wing import Roles, roles

BEAT_S = 1.0
GAP_S = 3.0  # or three periods of the receiver
MEMORY_S = 60.0  # the difference of two heights is tracked over this time [s]
AFRESH_S = 300.0  # after a longer disagreement the pair is compared anew, as if a source had been reset [s]
REBUILD_S = 120.0  # the other height is a stand-in for at most this long [s]
READMIT_S = 2.0
MARGIN = 1.5  # factor on every limit: a training flight of minutes does not show everything
FREE_M = 1e6  # a limit that nothing exceeds
FINEST_M = np.array([1.5, 3.0])  # of a jump and of a drift: healthy heights differ by so much on any flight
LEAST_S = 60.0  # needed for the comparison, after the minute that fills the memory


def build(log: Log, seed: int, session: Session) -> Model:
    """Fit on a healthy flight; the fit is deterministic.

    Raises:
        LogError: fewer than two sources of the height, or too short a flight.
    """
    found = roles(log)
    sources = height_sources(NAME, log)
    columns, pairs = tuple(sources), tuple(combinations(range(len(sources)), 2))
    free = Agreement(
        limit=jnp.full((2, len(pairs)), FREE_M),
        upward=jnp.asarray(list(sources.values())),
        beat_s=jnp.asarray(BEAT_S),
        gap_s=jnp.asarray(max(GAP_S, 3 * _period_s(log, columns[0]))),
        afresh_s=jnp.asarray(AFRESH_S),
        columns=columns,
        pairs=pairs,
        owner=_owners(log, found),
    )
    residual = TwoHeights(
        memory_s=jnp.asarray(MEMORY_S),
        variance=jnp.asarray(1.0),
        heights=tuple(c for c, upward in sources.items() if upward == 0),
        watched=columns,
        channels=len(log.channels),
    )
    session.progress("measuring how far healthy heights move apart")
    limit = _limit(log, residual, free)
    # of the first two sources, which are the two heights if there are two
    variance = (limit[0, 0] / 3) ** 2 if np.isfinite(limit[0, 0]) else 1.0
    residual = eqx.tree_at(lambda r: r.variance, residual, jnp.asarray(variance))
    agreement = eqx.tree_at(lambda s: s.limit, free, jnp.asarray(limit))
    paths = [log.channels[c].path for c in columns]
    names = [TOGETHER.join((paths[i], paths[j])) for i, j in pairs]
    spans = [f"apart within {length * BEAT_S:g} s" for length in (RECENT, RECENT + PAST)]
    summary = {
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
        summary=summary,
    )


def _limit(log: Log, residual: TwoHeights, free: Agreement) -> Float[np.ndarray, "2 P"]:
    """Limit of each pair, a margin above its largest healthy difference; +inf for a pair that was never compared.

    Raises:
        LogError: too few samples could be compared.
    """
    score = open_loop_scores(_monitor(log, residual, free, np.inf), log)[0]
    tested = np.isfinite(score)
    if tested[:, len(free.pairs) :].any(axis=1).sum() * log.period_s < LEAST_S:
        raise LogError(
            f"{log.name} is {log.duration_s:.0f} s long, but {NAME} needs {2 * LEAST_S:g} s of heights without a gap; "
            "give a longer flight."
        )
    largest = (FREE_M * np.where(tested, score, 0.0).max(axis=0)).reshape(free.limit.shape)
    known = tested.any(axis=0).reshape(free.limit.shape)
    return np.where(known, MARGIN * np.maximum(largest, FINEST_M[:, None]), np.inf)


def _owners(log: Log, found: Roles) -> tuple[int, ...]:
    """Which channels may fail together: those of one sensor, and the receiver's height and vertical speed even where
    the log has them as two sensors.
    """
    owner = list(owners(log.channels, log.sensors))
    if found.height is not None and found.vertical is not None:
        owner = [owner[found.height] if s == owner[found.vertical] else s for s in owner]
    return tuple(owner)


def _monitor(log: Log, residual: TwoHeights, agreement: Agreement, limit: float) -> Monitor:
    """Alarm where a pair differs by more than `limit` times its own limit. A vertical speed has no stand-in."""
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
    title="Receiver, barometer and vertical speeds, compared in pairs over a minute; isolates the sensor if a third "
    "source can decide",
    source="this project's own study (`sensorfault reproduce multistep`): mean pair against an independent reference",
    false_alarm_rate="not designed: each limit is 50 % above the largest healthy difference; a flight of minutes is "
    "too short to measure the rate of a test with a memory of a minute",
    build=build,
    needs=height_sources,
)
