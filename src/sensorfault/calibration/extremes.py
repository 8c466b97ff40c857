"""Robust extremes of healthy data: a few contaminated rows do not spoil them."""

import numpy as np
from jaxtyping import Bool, Float

# number, share and largest share of the top sizes that are ignored as possible faults
LEAST, SHARE, MOST = 20, 0.003, 0.05
BODY = 5  # the tail is fitted from the quantile with so many times as many sizes above it
EXPECTED = 1e-2  # expected number of healthy sizes above the limit in a whole log


def tail_limit(size: Float[np.ndarray, " N"], tests: int = 1) -> float:
    """The value that some of the N healthy sizes (none negative) exceed in one of a hundred logs.

    The tail is extrapolated as a power law through two quantiles (Hill 1975). Noise and vibration have lighter tails
    and stay below. `tests`: number of limits that share the allowance.
    """
    beyond = min(max(SHARE, LEAST / len(size)), MOST)
    body, tail = np.quantile(size, (1 - BODY * beyond, 1 - beyond))
    if body <= 0:
        return float("inf")
    # H = ln(q2 / q1) / ln(p1 / p2),  q(p) = q2 (p2 / p)^H
    h = np.log(tail / body) / np.log(BODY)
    return float(tail * max(beyond * len(size) * tests / EXPECTED, 1.0) ** h)


def explained(value: Float[np.ndarray, "N C"]) -> Bool[np.ndarray, "N C"]:
    """Which entries are no outliers: not farther from their channel's median than the tail of the others allows."""
    away = np.abs(value - np.median(value, axis=0))
    limit = np.array([tail_limit(channel) for channel in away.T])
    near: Bool[np.ndarray, "N C"] = away <= limit
    return near


def explained_max(score: Float[np.ndarray, " N"]) -> float:
    """The largest score (none negative) that is no outlier."""
    return float(score[score <= tail_limit(score)].max())
