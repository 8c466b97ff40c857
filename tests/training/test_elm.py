"""The extreme learning machine against the paper's formulas as they are printed, and a textbook one."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import expit

from sensorfault.calibration.scaling import Scaling
from sensorfault.training.elm import fit_elm, ridge


def printed(hidden: np.ndarray, target: np.ndarray, c: float) -> np.ndarray:
    """Equation (7) as it stands: beta = H' (I/C + H H')^-1 X, an N by N inverse."""
    return hidden.T @ np.linalg.inv(np.eye(len(hidden)) / c + hidden @ hidden.T) @ target


@given(st.integers(1, 60), st.integers(1, 40), st.integers(1, 7), st.sampled_from([1e-2, 1.0, 1e3]), st.integers(0, 99))
@settings(max_examples=60, deadline=None)
def test_ridge_is_the_printed_formula(rows: int, width: int, channels: int, c: float, seed: int) -> None:
    rng = np.random.default_rng(seed)
    hidden, target = expit(rng.standard_normal((rows, width))), rng.uniform(-1, 1, (rows, channels))
    want = printed(hidden, target, c)
    assert np.abs(ridge(hidden, target, c) - want).max() <= 1e-8 * max(1.0, np.abs(want).max())


@pytest.mark.parametrize(("rows", "width"), [(10, 32), (31, 32), (32, 32), (33, 32), (200, 32)])
def test_ridge_minimises_its_cost(rows: int, width: int) -> None:
    """Ridge regression: the gradient of |H beta - X|^2 + |beta|^2 / C is nothing at the answer."""
    rng = np.random.default_rng(rows)
    hidden, target = rng.uniform(0, 1, (rows, width)), rng.uniform(-1, 1, (rows, 6))
    beta = ridge(hidden, target, 1e3)
    assert np.abs(hidden.T @ (hidden @ beta - target) + beta / 1e3).max() < 1e-9


def textbook(value: np.ndarray, hidden: int, c: float, seed: int) -> tuple[np.ndarray, ...]:
    """Min et al. 2021, section 2.1, one sample and one node after the other."""
    rng = np.random.default_rng(seed)
    w = rng.uniform(-1, 1, (hidden, value.shape[1]))
    b = rng.uniform(-1, 1, hidden)
    low, high = value.min(axis=0), value.max(axis=0)
    x = 2 * (value - low) / (high - low) - 1
    h = np.array([[1 / (1 + np.exp(-(w[j] @ row + b[j]))) for j in range(hidden)] for row in x])
    beta = printed(h, x, c)
    error = (x - h @ beta) * (high - low) / 2
    return w, b, beta, error


@pytest.mark.parametrize("rows", [20, 300])
def test_fit_elm_is_the_textbook_one(rows: int) -> None:
    rng = np.random.default_rng(3)
    value = rng.standard_normal((rows, 4)) * (0.1, 1, 10, 100) + (0, 5, -3, 1000)
    fitted = fit_elm(value, Scaling.of(value, np.ones(4, bool)), hidden=32, c=1e3, seed=5)
    w, b, beta, error = textbook(value, 32, 1e3, 5)
    np.testing.assert_array_equal(fitted.weights, w)
    np.testing.assert_array_equal(fitted.bias, b)
    np.testing.assert_allclose(fitted.output, beta.T, rtol=0, atol=1e-7 * np.abs(beta).max())
    np.testing.assert_array_equal(fitted.offset, np.zeros(4))
    np.testing.assert_allclose(fitted.cov, np.cov(error, rowvar=False), rtol=1e-5)
    np.testing.assert_allclose(fitted.center, (value.min(axis=0) + value.max(axis=0)) / 2, rtol=1e-12)
    np.testing.assert_allclose(fitted.half, (value.max(axis=0) - value.min(axis=0)) / 2, rtol=1e-12)
    assert fitted.activation == "sigmoid"


def test_hidden_weights_are_uniform_and_of_the_seed_alone() -> None:
    value = np.random.default_rng(0).uniform(-1, 1, (50, 6))
    scaling = Scaling.of(value, np.ones(6, bool))
    one, again, other = (fit_elm(value, scaling, hidden=500, seed=seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(one.weights, again.weights)
    np.testing.assert_array_equal(one.output, again.output)
    assert (np.asarray(one.weights) != np.asarray(other.weights)).mean() > 0.99
    drawn = np.asarray(one.weights)
    assert np.abs(drawn).max() < 1
    # mean 0 and variance 1/3, within four standard errors of 3000 draws
    assert abs(drawn.mean()) < 4 * np.sqrt(1 / 3 / drawn.size)
    assert abs(drawn.var() - 1 / 3) < 4 * np.sqrt(4 / 45 / drawn.size)


def test_it_learns_to_copy() -> None:
    """On three causes in six channels the network leaves much less than it was given, also of rows it has not seen."""
    rng = np.random.default_rng(2)
    mixing = rng.uniform(-1, 1, (3, 6))
    train, unseen = (rng.uniform(-1, 1, (n, 3)) @ mixing for n in (500, 200))
    scaling = Scaling.of(train, np.ones(6, bool))
    fitted = fit_elm(train, scaling)
    x = (unseen - np.asarray(fitted.center)) / np.asarray(fitted.half)
    copy = expit(x @ np.asarray(fitted.weights).T + np.asarray(fitted.bias)) @ np.asarray(fitted.output).T
    assert np.sqrt(np.mean((x - copy) ** 2)) < 0.03 * np.sqrt(np.mean(x**2))


@pytest.mark.parametrize("rows", [20, 300])
def test_an_unwatched_channel_carries_no_weight(rows: int) -> None:
    """Whatever it holds, the network of the others is the same, and nothing is asked of it or said of it."""
    rng = np.random.default_rng(4)
    value = rng.standard_normal((rows, 5))
    watched = np.array([True, False, True, True, False])
    wild = value.copy()
    wild[:, ~watched] = 1e6 * rng.standard_normal((rows, 2))
    calm, other = (fit_elm(v, Scaling.of(v, watched)) for v in (value, wild))
    for name in ("weights", "offset", "output", "center", "half", "cov", "watched"):
        np.testing.assert_array_equal(getattr(calm, name), getattr(other, name), err_msg=name)
    assert not np.asarray(calm.weights)[:, ~watched].any()
    assert not np.asarray(calm.output)[~watched].any()
    np.testing.assert_array_equal(np.asarray(calm.cov)[~watched][:, ~watched], np.eye(2))
    assert not np.asarray(calm.cov)[~watched][:, watched].any()
    assert np.linalg.matrix_rank(np.asarray(calm.cov)) == 5


def test_one_watched_channel_is_enough() -> None:
    value = np.sin(np.arange(100.0))[:, None]
    fitted = fit_elm(value, Scaling.of(value, np.ones(1, bool)))
    assert np.asarray(fitted.cov).shape == (1, 1)
    assert 0 < float(fitted.cov[0, 0]) < 0.01
