"""The velocity against the inertial unit, along and across: two tests, each accusing what could cause it."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import Residual, Score, Trust


class Slippage(eqx.Module):
    """|slip| / sigma along and across, of residual/velocity_deficit.py. `along`, `across`: whom each accuses."""

    sigma: Float[Array, "2"]  # [m/s]
    along: Bool[Array, " C"]
    across: Bool[Array, " C"]

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        result = residual.extra
        covers = jnp.stack([self.along, self.across])
        there = result.ready & ~(covers & jnp.asarray(residual.out)[..., None, :]).any()
        value = jnp.abs(result.slip) / self.sigma
        return Score(value, jnp.stack([there, there]), covers, covers.astype(value.dtype)), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
