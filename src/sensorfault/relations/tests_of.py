"""All tests of one piece of a log: every relation over every window."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from sensorfault.relations import lag
from sensorfault.relations.change import WINDOWS_2_S, WINDOWS_S, change
from sensorfault.relations.grid import Grid, unwrapped, wrapped
from sensorfault.relations.table import Relation, residual, rows

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
    tests, moved, common = [], [], []
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
        d = residual(relation, left, right)
        least_s = LEAST_PERIODS * _slowest_s(grid, relation)
        for window_s in (window for window in _windows(relation) if window >= least_s):
            if duration < SHORT * window_s:
                continue
            one = change(d, window_s, relation.order)
            tests.append(Test(relation, window_s))
            moved.append(wrapped(one) if relation.circular else one)
            alone = [change(unwrapped(x) if relation.circular else x, window_s, relation.order) for x in (left, right)]
            common.append(np.minimum(*np.abs(alone)))
    shape = (len(tests), len(grid.time))
    return Piece(grid, tuple(tests), np.reshape(moved, shape).T, np.reshape(common, shape).T)
