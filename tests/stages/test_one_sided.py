"""The one-sided test: signed, by its own standard deviation, and only of what is there."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp
import numpy as np

from sensorfault.core.types import Residual
from sensorfault.stages.statistic.one_sided import OneSided


def test_late_is_signed_and_in_sigmas() -> None:
    value, cov = np.array([6.0, -6.0, 5.0]), np.array([[4.0, 1.0, 0.0], [1.0, 9.0, 0.0], [0.0, 0.0, 1.0]])
    zero, three = jnp.zeros(()), jnp.zeros(3)
    there = jnp.array([True, True, False])
    seen = Residual(zero, jnp.asarray(value), jnp.asarray(cov), three, three, three, there, three > 1)
    score, _ = OneSided().evaluate((), seen)
    np.testing.assert_allclose(score.value, [3.0, -2.0, 5.0])
    np.testing.assert_array_equal(score.valid, there)
    np.testing.assert_array_equal(score.covers, np.eye(3, dtype=bool))
    np.testing.assert_array_equal(score.blame, np.eye(3))
