"""All tests of one piece of a log: every relation over every window."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from sensorfault.relations import lag
from sensorfault.relations.change import WINDOWS_2_S, WINDOWS_S, change
from sensorfault.relations.grid import STEP_S, Grid, unwrapped, wrapped
from sensorfault.relations.table import Relation, residual, rows

Numbers = Float[np.ndarray, " T"]
DRIFTING, LONGEST_DRIFTING_S = {"acc", "side", "steering", "accelerometer"}, 15.0
LEAST_PERIODS = 1.5  # a window must hold this many measurements of the slower device
SHORT = 1.3  # a window is used where the piece is this many times longer


@dataclass(frozen=True)
class Test:
    """One relation over one window [s]."""

    relation: Relation
    window_s: float

    @property
    def key(self) -> str:
        """Unique in a log."""
        return f"{self.relation.name} over {self.window_s:g} s"

    @property
    def kind(self) -> tuple[str, float]:
        """What has the same limits."""
        return self.relation.kind, self.window_s


@dataclass(frozen=True)
class Pair:
    """The two witnesses of a relation on T ticks, angles without jumps, and the windows over which they are compared.

    `lag_s`: how much later the left one is. `apart`: left minus right.
    """

    relation: Relation
    windows_s: tuple[float, ...]
    lag_s: float
    apart: Numbers
    left: Numbers
    right: Numbers


@dataclass(frozen=True)
class Piece:
    """The K tests of a piece on its T ticks; NaN where a test has nothing to compare.

    `moved`: how far the two witnesses moved apart. `common`: how far both moved, by the one that moved less: no single
    liar makes it larger. `pairs`: what they were made of.
    """

    grid: Grid
    tests: tuple[Test, ...]
    moved: Float[np.ndarray, "T K"]
    common: Float[np.ndarray, "T K"]
    pairs: tuple[Pair, ...] = ()


def _slowest_s(grid: Grid, relation: Relation) -> float:
    """The period of the slower of the two devices."""
    periods = []
    for device in {device for (device, _), _ in relation.blame}:
        mine = [s.period_s for key, s in grid.signals.items() if key.partition(".")[0] == device]
        periods.append(min(mine, default=0.0))
    return max(periods, default=0.0)


def _windows(relation: Relation) -> tuple[float, ...]:
    """Windows of a relation: no long ones where a constant error grows with the motion, not with the time."""
    if relation.order == 2:
        return WINDOWS_2_S
    short = DRIFTING & set(relation.kind.split("|"))
    return tuple(window for window in WINDOWS_S if not short or window <= LONGEST_DRIFTING_S)


def judged(grid: Grid, courses: bool, lags: dict[str, float]) -> Piece:
    """All tests of a piece. `lags`: of each relation [s]; one that is not there is fitted and added."""
    pairs = []
    for relation in rows(set(grid.signals), courses):
        both = relation.difference(grid)
        if both is None or np.isfinite(both[0] - both[1]).sum() < 10:
            continue
        if relation.lagged and relation.name not in lags:
            lags[relation.name] = lag.fitted(*both, relation.order)
        least_s, most_s = LEAST_PERIODS * _slowest_s(grid, relation), (grid.end_s - grid.start_s) / SHORT
        windows_s = tuple(window_s for window_s in _windows(relation) if least_s <= window_s <= most_s)
        pairs.append(paired(relation, windows_s, lags[relation.name] if relation.lagged else 0.0, *both))
    return compared(grid, tuple(pairs))


def paired(relation: Relation, windows_s: tuple[float, ...], lag_s: float, left: Numbers, right: Numbers) -> Pair:
    """Two witnesses, the right one as late as the left."""
    right = lag.shifted(right, lag_s)
    apart = residual(relation, left, right)
    if relation.circular:
        left, right = unwrapped(left), unwrapped(right)
    return Pair(relation, windows_s, lag_s, apart, left, right)


def compared(grid: Grid, pairs: tuple[Pair, ...], known: Piece | None = None, keep: int = 0) -> Piece:
    """Each pair over each of its windows; all of one window at once. What is `known` is kept up to tick `keep`."""
    tests = tuple(Test(pair.relation, window_s) for pair in pairs for window_s in pair.windows_s)
    of = np.repeat(np.arange(len(pairs)), [len(pair.windows_s) for pair in pairs])
    begin = max(keep - round(max(WINDOWS_S) / STEP_S) - 1, 0)
    moved, common = np.empty((2, len(grid.time) - begin, len(tests)))
    if tests:
        apart, left, right = (
            np.stack([getattr(pair, name)[begin:] for pair in pairs], axis=1) for name in ("apart", "left", "right")
        )
    shape = [(test.window_s, test.relation.order) for test in tests]
    for window_s, order in dict.fromkeys(shape):
        mine = [k for k, one in enumerate(shape) if one == (window_s, order)]
        here = of[mine]
        moved[:, mine] = change(apart[:, here], window_s, order)
        common[:, mine] = np.minimum(*(np.abs(change(x[:, here], window_s, order)) for x in (left, right)))
    circular = [k for k, test in enumerate(tests) if test.relation.circular]
    moved[:, circular] = wrapped(moved[:, circular])
    if known is not None:
        moved = np.concatenate([known.moved[:keep], moved[keep - begin :]])
        common = np.concatenate([known.common[:keep], common[keep - begin :]])
    return Piece(grid, tests, moved, common, pairs)
