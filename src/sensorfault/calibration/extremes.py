"""How far out health alone may lie: extremes that one contaminated row does not ruin."""

import numpy as np
from jaxtyping import Bool, Float

LEAST, SHARE, MOST = 20, 0.003, 0.05  # of the sizes, those too far out to have a say: faults may be among them
BODY = 5  # times as many lie beyond the point from which the tail is measured
EXPECTED = 1e-2  # healthy sizes beyond the limit that a whole log should hold


def tail_limit(size: Float[np.ndarray, " N"], tests: int = 1) -> float:
    """The value that, of so many healthy sizes (none negative), any would exceed in one log of a hundred.

    The tail is taken to fall off as a power between two of its quantiles (Hill 1975) and drawn out from there: noise
    and vibration are lighter than that and stay below. `tests`: how many such limits share the allowance.
    """
    beyond = min(max(SHARE, LEAST / len(size)), MOST)
    body, tail = np.quantile(size, (1 - BODY * beyond, 1 - beyond))
    if body <= 0:
        return float("inf")
    # H = ln(q2 / q1) / ln(p1 / p2),  q(p) = q2 (p2 / p)^H
    h = np.log(tail / body) / np.log(BODY)
    return float(tail * max(beyond * len(size) * tests / EXPECTED, 1.0) ** h)


def explained(value: Float[np.ndarray, "N C"]) -> Bool[np.ndarray, "N C"]:
    """Which entries lie no farther from their channel's median than its other values lead to expect."""
    away = np.abs(value - np.median(value, axis=0))
    limit = np.array([tail_limit(channel) for channel in away.T])
    near: Bool[np.ndarray, "N C"] = away <= limit
    return near


def explained_max(score: Float[np.ndarray, " N"]) -> float:
    """The largest of the scores (none negative) that the others lead to expect."""
    return float(score[score <= tail_limit(score)].max())
