import pytest
from scipy.stats import chi2

from sensorfault.numerics.poisson import rate_below


@pytest.mark.parametrize("count", [0, 1, 2, 5, 20, 300])
def test_the_upper_limit_is_that_of_chi_square(count: int) -> None:
    assert rate_below(count, 2.5) == pytest.approx(chi2.ppf(0.95, 2 * (count + 1)) / 2 / 2.5, rel=0.011)


def test_without_time_nothing_is_known() -> None:
    assert rate_below(0, 0.0) == float("inf")
