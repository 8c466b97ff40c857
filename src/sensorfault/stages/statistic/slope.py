"""The slope of a window: how fast a residual drifts."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.numerics.blocks import Window


class Slope(eqx.Module):
    """|slope| of the straight line through each channel's window, by weighted least squares [SI/s]."""

    def __call__(self, seen: Window) -> Float[Array, " C"]:
        total = jnp.maximum(seen.weight.sum(axis=0), 1e-300)
        t = seen.age - ((seen.weight * seen.age).sum(axis=0) / total)[None]
        y = seen.value - ((seen.weight * seen.value).sum(axis=0) / total)[None]
        # b = Σ w t y / Σ w t²
        spread = (seen.weight * t**2).sum(axis=0)
        return jnp.abs((seen.weight * t * y).sum(axis=0)) / jnp.where(spread > 0, spread, jnp.inf)
