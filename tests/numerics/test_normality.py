"""The table of finite samples against a simulation of its own, and its limit against chi-square's."""

import numpy as np
import pytest
from scipy import stats

from sensorfault.numerics.normality import SIZES, TABLE, jarque_bera_quantile


@pytest.mark.parametrize("n", [20, 35, 98, 400])
def test_quantiles_by_simulation(n: int) -> None:
    found = stats.jarque_bera(np.random.default_rng(n).standard_normal((40_000, n)), axis=1).statistic
    for probability, within in ((0.5, 0.02), (0.95, 0.04), (0.99, 0.08)):
        assert float(jarque_bera_quantile(n, probability)) == pytest.approx(np.quantile(found, probability), rel=within)


def test_known_points() -> None:
    """EXPERIMENTS A3: about 3.8, 5.0, 5.4, 5.9 at n = 20, 50, 98, 500 for 5 %; 5.99 without end."""
    found = jarque_bera_quantile(np.array([20.0, 50.0, 98.0, 500.0, 1e12]), 0.95)
    np.testing.assert_allclose(found, [3.8, 5.0, 5.4, 5.9, stats.chi2.ppf(0.95, 2)], atol=0.06)


def test_the_table_rises() -> None:
    assert len(TABLE) == len(SIZES)
    assert (np.diff(TABLE, axis=1) > 0).all()
