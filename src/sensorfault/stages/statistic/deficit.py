"""Motion deficits in units of what health explains: one test a horizon, all accusing the position."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool

from sensorfault.core.types import Residual, Score, Trust


class Deficit(eqx.Module):
    """|way - displacement| / sigma for each horizon of residual/motion_deficit.py. `accused`: the position."""

    accused: Bool[Array, " C"]

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        result = residual.extra
        there = ~(self.accused & jnp.asarray(residual.out)).any()
        covers = jnp.broadcast_to(self.accused[None], (*result.ready.shape, len(self.accused)))
        value = jnp.linalg.norm(result.deficit, axis=1) / result.sigma
        return Score(value, result.ready & there, covers, covers.astype(value.dtype)), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
