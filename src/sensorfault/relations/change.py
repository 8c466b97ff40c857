"""How much two witnesses of one quantity moved apart within a window: D_w."""

import numpy as np
from jaxtyping import Float

from sensorfault.relations.grid import STEP_S

WINDOWS_S = (1.0, 4.0, 15.0, 60.0)  # of a change
WINDOWS_2_S = (2.0, 4.0, 8.0)  # of a change of slope
ENDS_S = 3.0  # most that is averaged at each end of a window


def mean_of_last(x: Float[np.ndarray, " T"], count: int) -> Float[np.ndarray, " T"]:
    """Mean of the last `count` ticks; NaN where fewer than 60 % of them are there."""
    if count <= 1:
        return x
    there = np.isfinite(x)
    total = np.cumsum(np.r_[np.zeros(count), np.where(there, x, 0.0)])
    number = np.cumsum(np.r_[np.zeros(count), there])
    total, number = total[count:] - total[:-count], number[count:] - number[:-count]
    return np.where(number >= 0.6 * count, total / np.maximum(number, 1), np.nan)


def delayed(x: Float[np.ndarray, " T"], count: int) -> Float[np.ndarray, " T"]:
    """The same, `count` ticks later."""
    out = np.full_like(x, np.nan)
    out[count:] = x[: len(x) - count] if count < len(x) else x[:0]
    return out


def change(d: Float[np.ndarray, " T"], window_s: float, order: int) -> Float[np.ndarray, " T"]:
    """D_w of the difference d of two witnesses; NaN where the window spans a hole.

    Order 1: mean of the window's last a ticks minus mean of its first a, a = min(w / 4, 3 s). Order 2: change of slope,
    the second difference over w.
    """
    width = round(window_s / STEP_S)
    if order == 1:
        ends = max(round(min(window_s / 4, ENDS_S) / STEP_S), 1)
        mean = mean_of_last(d, ends)
        moved = mean - delayed(mean, max(width - ends, 1))
    else:
        mean = mean_of_last(d, 2)
        moved = mean - 2 * delayed(mean, width // 2) + delayed(mean, width)
    holes = np.cumsum(np.r_[0, ~np.isfinite(d)])
    end = np.arange(1, len(d) + 1)
    spans = holes[end] - holes[np.maximum(end - width - 1, 0)] > 0
    return np.where(spans, np.nan, moved)
