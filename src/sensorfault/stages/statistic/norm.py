"""Euclidean norm of the scaled residual: one test a sample, blamed by each channel's share."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.core.types import Residual, Score, Trust


class Norm(eqx.Module):
    """||e|| with e = residual / scale, over the valid channels. Min et al. 2021, equations (5) and (9).

    Blame is the channel's share of the squared norm.
    """

    scale: Float[Array, " C"]  # [SI]

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        e = jnp.where(residual.valid, residual.value / self.scale, 0.0)
        largest = jnp.maximum(jnp.abs(e).max(), 1e-300)  # taken out before squaring, against overflow
        square = (e / largest) ** 2
        total = square.sum()
        score = Score(
            value=largest * jnp.sqrt(total)[None],
            valid=residual.valid.any()[None],
            covers=residual.valid[None],
            blame=(square / jnp.where(total > 0, total, 1.0))[None],
        )
        return score, ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
