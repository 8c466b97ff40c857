"""The window's three tests against SciPy on the very samples in it."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy import stats

from laws.strict import strict
from sensorfault.core.types import Residual
from sensorfault.stages.statistic.normality import Normality

__all__ = ["strict"]

HZ, WINDOW_S, BLOCKS = 50.0, 10.0, 20


def statistic(every: int = 1, memory: float = 0.0, sigma: float = 1.0) -> Normality:
    one = jnp.ones(1)
    return Normality((1,), 2, memory * one, sigma * one, 8 * one, every * one, jnp.asarray(WINDOW_S), BLOCKS)


@jax.jit
def scores(statistic: Normality, time, value, valid):
    """The three scores after every sample (NaN where not valid); of the two channels the second is watched."""

    def one(state, row):
        now, x, good = row
        both, nil = jnp.stack([7 * x, x]), jnp.zeros(2)
        seen = Residual(now, both, 4 * jnp.eye(2), both, nil, nil, jnp.stack([good, good]), nil > 1)
        score, pending = statistic.evaluate(state, seen)
        return pending, jnp.where(score.valid, score.value, jnp.nan)

    return jax.lax.scan(one, statistic.init(), (time, value, valid))[1]


def run(statistic: Normality, value: np.ndarray, valid: np.ndarray | None = None, time: np.ndarray | None = None):
    time = np.arange(len(value)) / HZ if time is None else time
    valid = np.ones(len(value), bool) if valid is None else valid
    return np.asarray(scores(statistic, jnp.asarray(time), jnp.asarray(value), jnp.asarray(valid)))


def in_window(k: int) -> slice:
    """Rows of the blocks that are kept at row k: the one that fills, and the nineteen before it.

    The very first sample only stands before the second.
    """
    rows = round(WINDOW_S / BLOCKS * HZ)
    return slice(max((k // rows - BLOCKS + 1) * rows, 1), k + 1)


def expected(u: np.ndarray, sigma: float = 1.0) -> list[float]:
    n, variance = len(u), u.var()
    return [
        stats.jarque_bera(u).statistic,
        np.sqrt(n) * abs(u.mean()) / sigma,
        np.sqrt(n / 2) * max(np.log(variance / sigma**2), 0.0),
    ]


@pytest.mark.parametrize("offset", [0.0, 20.0])
def test_windows_are_as_scipy_says(offset: float) -> None:
    value = np.random.default_rng(0).gamma(3.0, size=3000) + offset
    result = run(statistic(), value)
    for k in (100, 499, 500, 1234, 2999):
        np.testing.assert_allclose(result[k], expected(value[in_window(k)] / 2), rtol=1e-6)


def test_decimated_and_whitened() -> None:
    """Each fifth valid sample, less half of the one before; the holes do not count."""
    rng = np.random.default_rng(1)
    value, valid = rng.standard_normal(3000), rng.uniform(size=3000) < 0.5
    result = run(statistic(5, 0.5, 0.7), np.where(valid, value, np.nan), valid)
    rows = np.flatnonzero(valid)[::5]
    u = (value[rows[1:]] / 2 - 0.5 * value[rows[:-1]] / 2) / np.sqrt(0.75)
    for k in (1500, 2500, 2999):
        k = int(np.flatnonzero(valid[: k + 1])[-1])
        span = in_window(k)
        mine = u[(rows[1:] >= span.start) & (rows[1:] <= k)]
        np.testing.assert_allclose(result[k], expected(mine, 0.7), rtol=1e-8)
    assert np.isnan(result[~valid]).all()


def test_an_hour_costs_no_digits() -> None:
    rng = np.random.default_rng(2)
    value = rng.standard_normal(round(3600 * HZ)) + 20.0
    value[1000:2000] = 1e9  # long gone
    result = run(statistic(), value)
    np.testing.assert_allclose(result[-1], expected(value[in_window(len(value) - 1)] / 2), rtol=1e-6)


def test_a_hole_in_the_clock_empties_the_window() -> None:
    value = np.random.default_rng(3).standard_normal(1000)
    time = np.arange(1000) / HZ
    result = run(statistic(), value, time=time + np.where(time > 10, 5.0, 0.0))
    assert np.isnan(result[501:509]).all()
    np.testing.assert_allclose(result[515], expected(value[502:516] / 2), rtol=1e-8)


def test_blind_to_bias_and_scale_but_its_companions_are_not() -> None:
    value = np.random.default_rng(4).standard_normal(1000)
    plain, biased, scaled = (run(statistic(sigma=0.5), x)[-1] for x in (value, value + 5, 3 * value))
    assert biased[0] == pytest.approx(plain[0], rel=1e-6)
    assert scaled[0] == pytest.approx(plain[0], rel=1e-6)
    assert biased[1] > 20 * plain[1]
    assert scaled[2] > plain[2] + 10
