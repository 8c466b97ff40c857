"""How much two witnesses of one quantity moved apart within a window: D_w."""

import numpy as np
from jaxtyping import Float, Shaped

from sensorfault.relations.grid import STEP_S

WINDOWS_S = (1.0, 4.0, 15.0, 60.0)  # of a change
WINDOWS_2_S = (2.0, 4.0, 8.0)  # of a change of slope
ENDS_S = 3.0  # most that is averaged at each end of a window


def mean_of_last(x: Float[np.ndarray, "T *R"], count: int) -> Float[np.ndarray, "T *R"]:
    """Mean of the last `count` ticks; NaN where fewer than 60 % of them are there."""
    if count <= 1:
        return x
    there = np.isfinite(x)
    total, number = _of_last(np.where(there, x, 0.0), count), _of_last(there, count)
    return np.where(number >= 0.6 * count, total / np.maximum(number, 1), np.nan)


def _of_last(x: Shaped[np.ndarray, "T *R"], count: int) -> Float[np.ndarray, "T *R"]:
    """Sum of the last `count` ticks."""
    total = np.cumsum(x, axis=0, dtype=float)
    return np.concatenate([total[:count], total[count:] - total[:-count]])


def delayed(x: Float[np.ndarray, "T *R"], count: int) -> Float[np.ndarray, "T *R"]:
    """The same, `count` ticks later."""
    out = np.full_like(x, np.nan)
    out[count:] = x[: len(x) - count] if count < len(x) else x[:0]
    return out


def change(d: Float[np.ndarray, "T *R"], window_s: float, order: int) -> Float[np.ndarray, "T *R"]:
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
    return np.where(_of_last(~np.isfinite(d), width + 1) > 0, np.nan, moved)
