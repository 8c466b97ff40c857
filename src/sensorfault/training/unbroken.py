"""Rows of a log that follow others without a gap."""

import numpy as np
from jaxtyping import Bool, Float

LAGS = 4


def unbroken(time: Float[np.ndarray, " T"], complete: Bool[np.ndarray, " T"], lags: int) -> Bool[np.ndarray, " T"]:
    """Complete rows after `lags` complete rows, without a gap in the clock."""
    step = np.diff(time)
    joined = np.concatenate([[False], step < 1.5 * np.median(step)]) & complete
    joined[1:] &= complete[:-1]
    whole = complete.copy()
    for lag in range(lags):
        whole[: lag + 1] = False
        whole[lag + 1 :] &= joined[1 : len(joined) - lag]
    return whole
