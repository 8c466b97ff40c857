"""Which points of a long signal to draw, so that the picture stays the same."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float, Int, Int8

Span = tuple[float, float]  # from, to [s]


def extremes(value: Float[np.ndarray, " T"], buckets: int) -> Int[np.ndarray, " K"]:
    """Rows of the least and the greatest value in each of `buckets` spans, and of both ends; rising.

    A spike of one sample is kept. Values must be finite.
    """
    rows = value.size
    if rows <= 2 * buckets:
        return np.arange(rows)
    width = -(-rows // buckets)
    start = np.arange(0, rows, width)
    table = np.pad(value, (0, start.size * width - rows), mode="edge").reshape(start.size, width)
    found = (start + table.argmin(axis=1), start + table.argmax(axis=1), [0, rows - 1])
    return np.unique(np.minimum(np.concatenate(found), rows - 1))


def near(time: Float[np.ndarray, " T"], spans: Sequence[Span], budget: int) -> Bool[np.ndarray, " T"]:
    """Rows in and around `spans` [s], about `budget` at most.

    The shortest spans are kept whole, with half their length and at least two seconds on either side, up to half the
    budget. The other spans share the rest of it for the rows around their starts and ends.
    """
    mask = np.zeros(time.size, dtype=bool)
    if not spans:
        return mask
    start, end = np.array(spans, dtype=float).T
    margin = np.maximum(2.0, (end - start) / 2)
    first, last = np.searchsorted(time, start - margin), np.searchsorted(time, end + margin)
    order = np.argsort(last - first)
    whole = np.cumsum((last - first)[order]) <= budget // 2
    for i in order[whole]:
        mask[first[i] : last[i]] = True
    most = max(1, budget // (8 * len(spans)))
    for edge in np.searchsorted(time, np.concatenate((start[order[~whole]], end[order[~whole]]))):
        mask[max(0, edge - most) : edge + most + 1] = True
    return mask


def line(
    time: Float[np.ndarray, " T"], value: Float[np.ndarray, " T"], keep: Bool[np.ndarray, " T"], points: int
) -> tuple[Float[np.ndarray, " K"], Float[np.ndarray, " K"]]:
    """About `points` points that draw `value` over `time` [s], all of `keep` among them; a NaN breaks the line at gaps.

    A gap is a step of more than three times the median step between two values, so a sensor slower than the log's rate
    is drawn as one line. Of very many gaps only the longest are shown.
    """
    finite = np.flatnonzero(np.isfinite(value))
    t, v = time[finite], value[finite]
    if t.size < 3:
        return t, v
    step = np.diff(t)
    gap = np.flatnonzero(step > 3 * np.median(step))
    gap = np.sort(gap[np.argsort(step[gap])[-points // 4 :]])
    drawn = np.unique(np.concatenate((extremes(v, points // 2), np.flatnonzero(keep[finite]), gap, gap + 1)))
    place = np.searchsorted(drawn, gap + 1)
    return np.insert(t[drawn], place, t[gap] + step[gap] / 2), np.insert(v[drawn], place, np.nan)


def runs(verdict: Int8[np.ndarray, " T"], most: int = 1500) -> tuple[Int[np.ndarray, " K"], Int8[np.ndarray, " K"]]:
    """First row and verdict of each run of the same verdict.

    If there are more than `most` runs, neighbours are merged and get the worst verdict among them: no fault is lost.
    """
    rows = verdict.size
    start = np.flatnonzero(np.diff(verdict, prepend=verdict[:1] - 1)) if rows else np.zeros(0, dtype=int)
    if start.size <= most:
        return start, verdict[start]
    bucket = np.arange(0, rows, -(-rows // most))
    worst = np.maximum.reduceat(verdict, bucket)
    first, value = runs(worst, most)
    return bucket[first], value
