"""All tests of one piece of a log: every relation over every window."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from sensorfault.relations import lag
from sensorfault.relations.change import WINDOWS_2_S, WINDOWS_S, change
from sensorfault.relations.grid import Grid, unwrapped, wrapped
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
class Piece:
    """The K tests of a piece on its T ticks; NaN where a test has nothing to compare.

    `moved`: how far the two witnesses moved apart. `common`: how far both moved, by the one that moved less: no single
    liar makes it larger.
    """

    grid: Grid
    tests: tuple[Test, ...]
    moved: Float[np.ndarray, "T K"]
    common: Float[np.ndarray, "T K"]


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
    tests: list[Test] = []
    column: list[int] = []  # of the relation of each test
    pairs: list[tuple[Numbers, Numbers, Numbers]] = []  # difference, left, right of each relation
    duration = grid.end_s - grid.start_s
    for relation in rows(set(grid.signals), courses):
        both = relation.difference(grid)
        if both is None or np.isfinite(both[0] - both[1]).sum() < 10:
            continue
        left, right = both
        if relation.lagged:
            if relation.name not in lags:
                lags[relation.name] = lag.fitted(left, right, relation.order)
            right = lag.shifted(right, lags[relation.name])
        least_s = LEAST_PERIODS * _slowest_s(grid, relation)
        mine = [window for window in _windows(relation) if window >= least_s and duration >= SHORT * window]
        tests += [Test(relation, window_s) for window_s in mine]
        column += [len(pairs)] * len(mine)
        whole = (unwrapped(left), unwrapped(right)) if relation.circular else (left, right)
        pairs.append((residual(relation, left, right), *whole))
    return Piece(grid, tuple(tests), *_changes(tests, np.array(column, int), pairs, len(grid.time)))


def _changes(
    tests: list[Test], column: Int[np.ndarray, " K"], pairs: list[tuple[Numbers, Numbers, Numbers]], ticks: int
) -> tuple[Float[np.ndarray, "T K"], Float[np.ndarray, "T K"]]:
    """How far the witnesses of each test moved apart, and how far both moved; all of one window at once."""
    moved, common = np.empty((ticks, len(tests))), np.empty((ticks, len(tests)))
    d, left, right = (np.stack(x, axis=1) for x in zip(*pairs, strict=True)) if pairs else (common,) * 3
    shape = [(test.window_s, test.relation.order) for test in tests]
    for window_s, order in dict.fromkeys(shape):
        mine = [k for k, one in enumerate(shape) if one == (window_s, order)]
        here = column[mine]
        moved[:, mine] = change(d[:, here], window_s, order)
        common[:, mine] = np.minimum(*(np.abs(change(x[:, here], window_s, order)) for x in (left, right)))
    circular = [k for k, test in enumerate(tests) if test.relation.circular]
    moved[:, circular] = wrapped(moved[:, circular])
    return moved, common
