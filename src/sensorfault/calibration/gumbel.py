"""The limit of a test from the block maxima of healthy scores; robust against faults in a few blocks."""

import numpy as np
from jaxtyping import Float

LEAST_BLOCKS = 4
MEDIAN, UPPER = -np.log(np.log(2.0)), -np.log(-np.log(0.75))  # reduced Gumbel variates of two quartiles


def gumbel_limit(
    score: Float[np.ndarray, "T K"], time: Float[np.ndarray, " T"], per_hour: float, block_s: float
) -> Float[np.ndarray, " K"]:
    """The limit of each test that a healthy drive exceeds `per_hour` times an hour; scores are NaN where not tested.

    Alarms come in clusters, so the largest score of each block of `block_s` counts. A Gumbel distribution is fitted to
    the median and the upper quartile of these maxima, so faults in less than a quarter of the training time are not
    learned. The limit is never below the median of the maxima, and +inf with fewer than LEAST_BLOCKS blocks.
    """
    block = ((time - time[0]) // block_s).astype(int)
    limit = np.full(score.shape[1], np.inf)
    for k, column in enumerate(score.T):
        tested = np.isfinite(column)
        largest = np.full(block[-1] + 1, -np.inf)
        np.maximum.at(largest, block[tested], column[tested])
        largest = largest[np.isfinite(largest)]
        if len(largest) < LEAST_BLOCKS:
            continue
        half, upper = np.quantile(largest, (0.5, 0.75))
        # F(x) = exp(-exp(-(x - μ) / β))
        beta = (upper - half) / (UPPER - MEDIAN)
        mu = half - beta * MEDIAN
        # 1 - F(limit) = per_hour block_s / 3600
        limit[k] = mu - beta * np.log(-np.log1p(-min(per_hour * block_s / 3600, 0.5)))
    return limit
