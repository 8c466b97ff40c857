"""Limits from the scores of healthy data."""

import numpy as np
from jaxtyping import Float

REPEATS_PER_HOUR = 1e-3  # false alarms allowed to the whole exact-repeat test of a channel
LEAST_RUN = 4.0


def repeat_limit(runs: Float[np.ndarray, "T C"], period_s: float) -> Float[np.ndarray, " C"]:
    """Longest run of exact repeats that health still explains, for each channel.

    With repeats independent of chance p, a run longer than n begins p^n / period times a second; solve for n at
    REPEATS_PER_HOUR, p taken at its upper 95 % bound where few were seen (rule of three). A channel whose repeats come
    in long runs (a wheel at rest) is given twice its longest healthy run. `runs` is NaN where nothing was tested.
    """
    tested = np.isfinite(runs)
    count = np.maximum(tested.sum(axis=0), 1)
    p = np.clip(((np.nan_to_num(runs) > 0).sum(axis=0) + 3) / count, 1e-9, 1 - 1e-9)
    # p^n 3600 / period = rate
    chance = np.log(REPEATS_PER_HOUR * period_s / 3600) / np.log(p)
    longest = np.nan_to_num(runs).max(axis=0)
    limit = np.maximum(np.maximum(np.ceil(chance), 2 * longest), LEAST_RUN)
    return np.where(tested.any(axis=0), limit, np.inf)
