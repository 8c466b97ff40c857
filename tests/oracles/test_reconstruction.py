"""The forward pass of the one-hidden-layer network, in plain NumPy."""

import jax.numpy as jnp
import numpy as np
import pytest
from scipy.special import expit

from laws.guests.zoo import log
from laws.walk import walk
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.residual.reconstruction import Reconstruction
from sensorfault.stages.statistic.exchange import Exchange
from sensorfault.stages.statistic.norm import Norm
from sensorfault.stages.threshold.fixed import Fixed

CHANNELS, HIDDEN = 4, 7
ACTIVATIONS = {"identity": lambda x: x, "sigmoid": expit, "tanh": np.tanh, "relu": lambda x: np.maximum(x, 0)}


@pytest.mark.parametrize("activation", ACTIVATIONS)
def test_forward_pass(activation: str) -> None:
    rng = np.random.default_rng(11)
    w, b, beta = rng.standard_normal((HIDDEN, CHANNELS)), rng.standard_normal(HIDDEN), rng.random((CHANNELS, HIDDEN))
    offset, center, half = rng.standard_normal((3, CHANNELS))
    half = np.abs(half) + 0.1
    watched = np.array([True, True, True, False])
    residual = Reconstruction(
        *map(jnp.asarray, (w, b, beta, offset, center, half, np.eye(CHANNELS), watched)), activation
    )
    value = center + half * rng.uniform(-1.5, 1.5, (20, CHANNELS))
    hold_s = jnp.zeros(CHANNELS)
    branch = Branch(Norm(jnp.ones(CHANNELS)), Fixed(jnp.array([jnp.inf])))
    result = walk(Monitor(residual, (branch,), Exceed(), Drop(), hold_s, (0, 1, 2, 3)), log(value)).reports
    for k in range(20):
        x = (value[k] - center) / half
        h = [ACTIVATIONS[activation](sum(w[j, i] * x[i] for i in range(CHANNELS)) + b[j]) for j in range(HIDDEN)]
        rebuilt = (beta @ h + offset) * half + center
        error = np.where(watched, value[k] - rebuilt, 0.0)
        np.testing.assert_allclose(result.residual.value[k], error, rtol=1e-12, atol=1e-12)
        np.testing.assert_array_equal(result.residual.valid[k], watched)
        np.testing.assert_allclose(result.scores[0].value[k, 0], np.linalg.norm(error[watched]), rtol=1e-12)
        np.testing.assert_allclose(result.scores[0].blame[k, 0], error**2 / (error @ error), rtol=1e-10, atol=1e-12)


def test_exchanged_channels_and_whom_they_blame() -> None:
    """Each channel in turn exchanged for its last trusted value, the network run anew on each such sample."""
    rng = np.random.default_rng(5)
    w, b, beta = rng.standard_normal((HIDDEN, CHANNELS)), rng.standard_normal(HIDDEN), rng.random((CHANNELS, HIDDEN))
    parts = [w, b, beta, np.zeros(CHANNELS), np.zeros(CHANNELS), np.ones(CHANNELS), np.eye(CHANNELS)]
    residual = Reconstruction(*map(jnp.asarray, parts), jnp.ones(CHANNELS, bool), "tanh")
    scale = np.array([1.0, 2.0, 0.5, 1.0])
    branch = Branch(Exchange(jnp.asarray(scale)), Fixed(jnp.array([jnp.inf])))
    value = rng.uniform(-1, 1, (12, CHANNELS))
    owner = tuple(range(CHANNELS))
    result = walk(Monitor(residual, (branch,), Exceed(), Drop(), jnp.zeros(CHANNELS), owner), log(value)).reports

    def left(x: np.ndarray) -> np.ndarray:
        return x - beta @ np.tanh(w @ x + b)

    for k in range(1, 12):  # limits are off, so what was measured last is what was trusted last
        norm = np.linalg.norm(left(value[k]) / scale)
        taken = np.zeros(CHANNELS)
        for c in range(CHANNELS):
            other = value[k].copy()
            other[c] = value[k - 1, c]
            np.testing.assert_allclose(result.residual.extra[k, c], left(other), rtol=1e-10, atol=1e-12)
            np.testing.assert_allclose(result.residual.expected[k, c], (other - left(other))[c], rtol=1e-10, atol=1e-12)
            taken[c] = max(norm**2 - np.linalg.norm(left(other) / scale) ** 2, 0.0)
        np.testing.assert_allclose(result.scores[0].value[k, 0], norm, rtol=1e-10)
        np.testing.assert_allclose(result.scores[0].blame[k, 0], taken / norm**2, rtol=1e-9, atol=1e-12)
