"""Averaged innovation (AIME): many innovations together show what none shows alone."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.numerics.blocks import Window


class AveragedInnovation(eqx.Module):
    """|z̄| √V⁻¹ of each channel, standard normal in absolute value where innovations are white.

    Diesel & Luu 1995, as Wang et al. 2023 use it: z̄ = Σ z/S / Σ 1/S over the window, with variance V = 1 / Σ 1/S.
    """

    def __call__(self, seen: Window) -> Float[Array, " C"]:
        # z̄ √V⁻¹ = Σ z/S / √(Σ 1/S)
        return jnp.abs((seen.weight * seen.value).sum(axis=0)) / jnp.sqrt(jnp.maximum(seen.weight.sum(axis=0), 1e-300))
