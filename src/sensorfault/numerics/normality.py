"""Quantiles of the Jarque-Bera statistic for finite samples of normal numbers."""

import numpy as np
from jaxtyping import Float

# Quantiles of JB of n independent normal numbers, a row a size, a column a probability, by simulation (2 million
# samples up to n = 98, a million up to 250, then 400,000; seed 20210531; good to 1 % up to 0.99, to some 5 % beyond).
# For n to infinity JB is chi-square with two degrees of freedom.
SIZES = (10, 20, 30, 50, 75, 98, 150, 250, 500, 1000, 2000)
PROBABILITIES = (0.5, 0.9, 0.95, 0.99, 0.999, 0.9999)
TABLE = (
    (0.6941, 1.618, 2.515, 5.673, 10.93, 15.32),  # n = 10
    (0.858, 2.35, 3.794, 9.731, 24.79, 46.98),  # n = 20
    (0.9459, 2.747, 4.407, 11.31, 30.45, 63.6),  # n = 30
    (1.046, 3.188, 4.981, 12.44, 33.94, 71.85),  # n = 50
    (1.114, 3.488, 5.275, 12.59, 33.07, 71.4),  # n = 75
    (1.153, 3.658, 5.416, 12.51, 31.82, 66.67),  # n = 98
    (1.207, 3.9, 5.6, 12.16, 30, 61.32),  # n = 150
    (1.259, 4.123, 5.746, 11.59, 26.24, 51.32),  # n = 250
    (1.313, 4.326, 5.861, 10.75, 22.18, 40.76),  # n = 500
    (1.338, 4.441, 5.896, 10.01, 18.42, 29.97),  # n = 1000
    (1.366, 4.542, 5.987, 9.774, 16.38, 25.35),  # n = 2000
)


def jarque_bera_quantile(n: Float[np.ndarray, "*s"] | float, probability: float) -> Float[np.ndarray, "*s"]:
    """Quantile of JB of n independent normal numbers for this probability (0.5 to 0.9999).

    Interpolated in 1/√n between sizes and in the logarithm of the tail between probabilities; below the smallest size
    that of the smallest, beyond the largest drawn on towards chi-square's.
    """
    tail = -np.log1p(-np.asarray(PROBABILITIES))
    at = -np.log1p(-probability)
    columns = np.array([np.interp(at, tail, row) for row in (*TABLE, 2 * tail)])
    roots = np.array([*(1 / np.sqrt(SIZES)), 0.0])
    return np.asarray(np.interp(1 / np.sqrt(np.maximum(n, SIZES[0])), roots[::-1], columns[::-1]))
