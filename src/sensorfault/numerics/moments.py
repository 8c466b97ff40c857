"""Central moments up to the fourth, updated by a value or by blocks without cancellation (Pébay 2008)."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float


class Moments(NamedTuple):
    """Number of values, mean, and sums of the second to fourth powers of the deviations from the mean."""

    n: Float[Array, "*s"]
    mean: Float[Array, "*s"]
    m2: Float[Array, "*s"]
    m3: Float[Array, "*s"]
    m4: Float[Array, "*s"]


def nothing(*shape: int) -> Moments:
    """Moments of no values."""
    return Moments(*(jnp.zeros(shape) for _ in range(5)))


def together(blocks: Moments) -> Moments:
    """Moments of all values of the blocks on the first axis."""
    n = blocks.n.sum(axis=0)
    mean = (blocks.n * blocks.mean).sum(axis=0) / jnp.maximum(n, 1.0)
    d = jnp.where(blocks.n > 0, blocks.mean - mean[None], 0.0)
    # Σ(x - m)² = Σ(x - m_b)² + n d²; likewise the third and the fourth by the binomial theorem
    m2 = blocks.m2 + blocks.n * d**2
    m3 = blocks.m3 + 3 * d * blocks.m2 + blocks.n * d**3
    m4 = blocks.m4 + 4 * d * blocks.m3 + 6 * d**2 * blocks.m2 + blocks.n * d**4
    return Moments(n, mean, m2.sum(axis=0), m3.sum(axis=0), m4.sum(axis=0))


def joined(block: Moments, value: Float[Array, "*s"]) -> Moments:
    """Moments with one more value."""
    one, zero = jnp.ones_like(value), jnp.zeros_like(value)
    both = zip(block, (one, value, zero, zero, zero), strict=True)
    return together(Moments(*(jnp.stack([a, b]) for a, b in both)))
