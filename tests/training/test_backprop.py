"""The autoencoder by backpropagation: the ELM's network, at least as good a copy."""

from dataclasses import replace

import jax
import numpy as np
from scipy.special import expit

from sensorfault.calibration.scaling import Scaling
from sensorfault.training.backprop import PLAN, fit_backprop, untrained
from sensorfault.training.elm import fit_elm

SHORT = replace(PLAN, epochs=150, rate=0.01)


def rows(count: int, seed: int) -> np.ndarray:
    """Three causes in six channels."""
    rng = np.random.default_rng(seed)
    mixing = np.random.default_rng(9).uniform(-1, 1, (3, 6))
    return np.tanh(rng.uniform(-1, 1, (count, 3)) @ mixing) * (0.1, 1, 2, 10, 1, 1) + (0, 5, 0, -3, 0, 0)


def test_it_copies_and_starts_where_the_elm_does() -> None:
    value, unseen = rows(800, 0), rows(200, 1)
    scaling = Scaling.of(value, np.ones(6, bool))
    elm, found = fit_elm(value, scaling, seed=4), fit_backprop(value, scaling, plan=SHORT, seed=4)
    start = untrained(6, 32, 4)
    np.testing.assert_array_equal(start.hidden[0].weights, elm.weights)
    np.testing.assert_array_equal(start.hidden[0].bias, elm.bias)
    assert found.weights.shape == (32, 6)
    assert found.activation == "sigmoid"
    x = (unseen - np.asarray(found.center)) / np.asarray(found.half)
    h = expit(x @ np.asarray(found.weights).T + np.asarray(found.bias))
    copy = h @ np.asarray(found.output).T + np.asarray(found.offset)
    assert np.sqrt(np.mean((copy - x) ** 2)) < 0.05 * np.sqrt(np.mean(x**2))


def test_an_unwatched_channel_carries_no_weight() -> None:
    value = rows(400, 2)
    watched = np.array([True, False, True, True, False, True])
    wild = value.copy()
    wild[:, ~watched] = 1e6 * np.random.default_rng(0).standard_normal((400, 2))
    calm, other = (fit_backprop(v, Scaling.of(v, watched), plan=replace(SHORT, epochs=5)) for v in (value, wild))
    for one, two in zip(jax.tree.leaves(calm), jax.tree.leaves(other), strict=True):
        np.testing.assert_array_equal(one, two)
    assert not np.asarray(calm.weights)[:, ~watched].any()
    assert not np.asarray(calm.output)[~watched].any()
