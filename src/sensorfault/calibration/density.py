"""Gaussian kernel density of healthy scores, and the limit that it gives for a false alarm rate."""

import numpy as np
from jaxtyping import Float

TURNS = 60  # bisections of the interval that contains the quantile


def silverman(scores: Float[np.ndarray, " n"]) -> float:
    """Bandwidth h = (4 / (3 n))^(1/5) σ. Silverman 1986, equation (3.28)."""
    return float((4 / (3 * len(scores))) ** 0.2 * scores.std(ddof=1))


def density_limit(scores: Float[np.ndarray, " n"], false_alarms: float) -> float:
    """The score with a share `false_alarms` of the healthy kernel density above it; NaN are left out.

    Wang et al. 2023 set the limit of the local outlier factor in this way. The density assumes independent scores and
    smooths the tail by h: on other data the rate can be several times as large. inf for fewer than two scores.
    """
    from scipy.special import ndtr

    known = scores[np.isfinite(scores)]
    if len(known) < 2:
        return float("inf")
    h = max(silverman(known), np.finfo(float).tiny)
    reach = 40 * h
    low, high = known.min() - reach, known.max() + reach
    for _ in range(TURNS):
        middle = (low + high) / 2
        # 1 - F(x) = mean of Φ((x_i - x) / h)
        above = ndtr((known - middle) / h).mean() > false_alarms
        low, high = (middle, high) if above else (low, middle)
    return float(high)
