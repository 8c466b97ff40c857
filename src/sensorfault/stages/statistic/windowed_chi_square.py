"""The sum of squared innovations over a window: is there more noise than there should be, or a mean that is not 0."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.numerics.blocks import Window


class WindowedChiSquare(eqx.Module):
    """q = Σ z²/S over the window, of n innovations χ²(n), as √(2q) - √(2n - 1), 0 where that is below.

    Fisher's normal form of χ², so that one limit serves whatever the number of fixes; about standard normal.
    """

    def __call__(self, seen: Window) -> Float[Array, " C"]:
        n = jnp.maximum(seen.many, 1.0)
        return jnp.maximum(jnp.sqrt(2 * seen.square) - jnp.sqrt(2 * n - 1), 0.0)
