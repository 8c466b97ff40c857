"""Means over short windows, and medians over neighbouring ones."""

import numpy as np
from jaxtyping import Float
from numpy.lib.stride_tricks import sliding_window_view


def windows(
    time: Float[np.ndarray, " n"], value: Float[np.ndarray, " n"], width: float, least: int = 3
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Centre, mean and standard deviation over windows beside each other that have enough measurements."""
    if not len(time):
        return np.zeros(0), np.zeros(0), np.zeros(0)
    bin_of = ((time - time[0]) / width).astype(int)
    count = np.bincount(bin_of)
    many = count >= least
    total, square, at = (np.bincount(bin_of, x)[many] / count[many] for x in (value, value * value, time))
    return at, total, np.sqrt(np.maximum(square - total * total, 0.0))


def median_of_last(x: np.ndarray, count: int) -> np.ndarray:
    """Median of the last `count`; 0 before there are so many."""
    if len(x) < count:
        return np.zeros(len(x))
    return np.concatenate([np.zeros(count - 1), np.median(sliding_window_view(x, count), axis=1)])


def median_around(x: np.ndarray, half: int) -> np.ndarray:
    """Median of each with `half` neighbours on each side."""
    wide = 2 * half + 1
    if len(x) < wide:
        return np.array([np.median(x[max(0, i - half) : i + half + 1]) for i in range(len(x))])
    first, last = ([np.median(ends[: half + 1 + i]) for i in range(half)] for ends in (x, x[::-1]))
    return np.concatenate([first, np.median(sliding_window_view(x, wide), axis=1), last[::-1]])
