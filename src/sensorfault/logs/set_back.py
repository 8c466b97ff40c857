"""Clocks that are set back by seconds and go on.

Late rows, rows that come twice and a second recording, which begins like the first, look much the same.
"""

import numpy as np
from jaxtyping import Float, Int

from sensorfault.logs.readers.source import Source

NEAR = 3.0  # a step of no more usual periods is as usual
_LASTS = 3  # rows before and after that must go on as usual
_MOST = 3  # a clock that seems to be set more often is none that is set: its rows are out of order
_LOOKED_AT = 20  # rows that are compared with those of the same times


def set_back(
    source: Source, rows: Int[np.ndarray, " n"], time: Float[np.ndarray, " n"], period_s: float, begun_s: float
) -> Int[np.ndarray, " k"]:
    """Where in the rows with a time the clock is set back: the last row before each of these steps.

    `rows`: of the source; negative ones are of a part before it. `begun_s`: the first time of the log.
    """
    steps = np.diff(time)
    found = [
        i
        for i in np.flatnonzero(steps < -NEAR * period_s).tolist()
        if time[i + 1] > begun_s and _goes_on(time, steps, i, NEAR * period_s) and not _repeated(source, rows, time, i)
    ]
    return np.array(found if len(found) <= _MOST else [], int)


def _goes_on(time: Float[np.ndarray, " n"], steps: Float[np.ndarray, " m"], i: int, usual_s: float) -> bool:
    """Whether the clock runs as usual before and after its step back, until it is again where it was.

    Late rows end with a step ahead to where the others are.
    """
    beside = np.r_[steps[max(0, i - _LASTS) : i], steps[i + 1 : i + 1 + _LASTS]]
    if len(beside) < 2 * _LASTS - 1 or (beside < 0).any() or (beside > usual_s).any():
        return False
    if time[i] < time[: i + 1].max() - usual_s:
        return False
    again = np.flatnonzero(time[i + 1 :] > time[i])
    until = i + 1 + int(again[0]) if len(again) else len(time) - 1
    within = steps[i + 1 : until]
    if (within >= 0).mean() <= 0.95 or within.max() > max(usual_s, -steps[i] / 4):
        return False
    return bool(not len(again) or steps[until - 1] <= usual_s)


def _repeated(source: Source, rows: Int[np.ndarray, " n"], time: Float[np.ndarray, " n"], i: int) -> bool:
    """Whether the rows after the step are rows from before it once more."""
    after = np.arange(i + 1, min(i + 1 + _LOOKED_AT, len(time)))
    before = np.searchsorted(time[: i + 1], time[after])
    there = (before <= i) & (time[np.minimum(before, i)] == time[after]) & (rows[np.minimum(before, i)] >= 0)
    if there.mean() < 0.5:
        return False
    one, other = source.frame[rows[after[there]]], source.frame[rows[before[there]]]
    return bool(sum(a == b for a, b in zip(one.rows(), other.rows(), strict=True)) > len(one) / 2)
