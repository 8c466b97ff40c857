"""Moments of blocks put together, against NumPy on all values at once."""

import jax.numpy as jnp
import numpy as np

from sensorfault.numerics.moments import Moments, joined, nothing, together


def test_blocks_together_are_all_values() -> None:
    rng = np.random.default_rng(0)
    values = [rng.gamma(2.0, size=(n, 3)) for n in (7, 0, 1, 30)]
    blocks = []
    for block in values:
        moments = nothing(3)
        for value in block:
            moments = joined(moments, jnp.asarray(value))
        blocks.append(moments)
    n, mean, *sums = together(Moments(*(jnp.stack(x) for x in zip(*blocks, strict=True))))
    whole = np.concatenate(values)
    np.testing.assert_array_equal(n, len(whole))
    np.testing.assert_allclose(mean, whole.mean(axis=0), rtol=1e-12)
    for power, result in zip((2, 3, 4), sums, strict=True):
        np.testing.assert_allclose(result, ((whole - whole.mean(axis=0)) ** power).sum(axis=0), rtol=1e-10)


def test_nothing_cancels_beside_a_large_mean() -> None:
    rng = np.random.default_rng(1)
    small = rng.standard_normal(200)
    moments = nothing()
    for value in small + 1e6:
        moments = joined(moments, jnp.asarray(value))
    np.testing.assert_allclose(moments.m4, ((small - small.mean()) ** 4).sum(), rtol=1e-6)
