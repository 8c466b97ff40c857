"""The k nearest of a set of points, inside a compiled step."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float, Int

ROW = 32  # XLA sums a longer axis in two passes, which costs time in live use
NAN = int(np.float32(np.nan).view(np.int32))  # of all bits of positive numbers the greatest


def nearest_in_order(
    points: Float[Array, " N"], one: Float[Array, ""], k: int
) -> tuple[Int[Array, " k"], Float[Array, " k"]]:
    """The k points nearest to one, of points in ascending order, and their distances."""
    # they are the k points after the last point i that is farther away than point i + k
    middle = (points[:-k] + points[k:]) / 2
    index = jnp.searchsorted(middle, one) + jnp.arange(k, dtype=jnp.int32)
    return index, jnp.abs(points[index] - one)


def in_rows(values: Float[Array, "F N"], fill: float) -> Float[Array, "F R 32"]:
    """The values of N points in rows; the last row is padded."""
    lacking = -values.shape[1] % ROW
    return jnp.pad(values, ((0, 0), (0, lacking)), constant_values=fill).reshape(len(values), -1, ROW)


def shares(
    points: Float[Array, "F R 32"], box: Float[Array, "F 2"], one: Float[Array, " F"], k: int
) -> tuple[Float[Array, "R 32"], Float[Array, "R 32"]]:
    """Which points are the k nearest to one, as shares: 1/k of each of them, 0 of others; and how far all of them are.

    `box` is the least and the greatest of each feature. Points equally far have equal shares of the places left.
    Equally far are those whose squares agree to seven digits; of one outside the box, what they exceed the box's by.
    """
    square, least = jnp.zeros(points.shape[1:]), jnp.zeros(())
    for x, row, (low, high) in zip(one, points, box, strict=True):
        square = square + (x - row) ** 2
        least = least + (x - jnp.clip(x, low, high)) ** 2
    # positive numbers are in the order of their bits
    key = lax.bitcast_convert_type(jnp.maximum(square - least, 0).astype(jnp.float32), jnp.int32)
    below, within, fewer, count = _narrowed(key, k)
    left, tied = (k - fewer).astype(jnp.float64), (count - fewer).astype(jnp.float64)
    return jnp.where(key <= below, 1.0, jnp.where(key <= within, left / tied, 0.0)) / k, jnp.sqrt(square)


def _narrowed(key: Int[Array, "R 32"], k: int) -> tuple[Array, Array, Array, Array]:
    """Two limits, and how many keys do not exceed them: fewer than k the first; k the second, or more where all tie.

    Halving a bracket takes some fifteen rounds, in which there is nothing to be predicted wrongly: a third less time
    than `lax.top_k`.
    """

    def wide(bracket: tuple[Array, Array, Array, Array]) -> Array:
        low, high, _, count = bracket
        return (count != k) & (high - low > 1)

    def halve(bracket: tuple[Array, Array, Array, Array]) -> tuple[Array, Array, Array, Array]:
        low, high, fewer, count = bracket
        middle = low + (high - low) // 2
        within = (key <= middle).sum(dtype=jnp.int32)
        few = within < k
        return (
            jnp.where(few, middle, low),
            jnp.where(few, high, middle),
            jnp.where(few, within, fewer),
            jnp.where(few, count, within),
        )

    found: tuple[Array, Array, Array, Array] = lax.while_loop(
        wide, halve, (jnp.int32(-1), jnp.int32(NAN), jnp.int32(0), jnp.int32(key.size))
    )
    return found
