"""Confidence bound of a rate from a count."""

Z95 = 1.6449  # one-sided 95 % point of the normal distribution


def rate_below(count: int, exposure: float) -> float:
    """Upper 95 % confidence bound of the rate after `count` events in `exposure`; inf without exposure.

    The upper Poisson limit is half the 95 % point of chi-square with 2 (count + 1) degrees of freedom, here by Wilson
    and Hilferty (1931), within 1 %: none seen is three at most.
    """
    if exposure <= 0:
        return float("inf")
    k = count + 1
    # chi2_p(2k) / 2 = k (1 - 1 / (9k) + z / (3 sqrt k))^3
    return float(k * (1 - 1 / (9 * k) + Z95 / (3 * k**0.5)) ** 3 / exposure)
