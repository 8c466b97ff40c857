"""Norm of the residual, blamed on the channel whose exchange makes it go away."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.core.types import Residual, Score, Trust


class Exchange(eqx.Module):
    """||e|| with e = residual / scale, over the valid channels. Min et al. 2021, equations (5) and (9).

    Needs `residual.extra[k]`, the residual left when channel k is exchanged for a trusted value. Blame is the share of
    the squared norm that the exchange takes away: a network smears a fault over its neighbours, so the largest residual
    is not always that of the faulty channel. Once a channel is out, the others are judged by what is left without it.
    """

    scale: Float[Array, " C"]  # [SI]

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        valid = residual.valid
        out = jnp.asarray(residual.out)
        e = jnp.where(valid, residual.value / self.scale, 0.0)
        e_k = jnp.where(valid[None], residual.extra / self.scale[None], 0.0)  # [k, channel]
        largest = jnp.maximum(jnp.abs(e).max(), 1e-300)  # taken out before squaring, against overflow
        without = ((e_k / largest) ** 2).sum(axis=1)
        total = jnp.where(out.any(), jnp.where(out, without, jnp.inf).min(), ((e / largest) ** 2).sum())
        taken = jnp.where(valid, jnp.maximum(total - without, 0.0), 0.0)
        score = Score(
            value=largest * jnp.sqrt(total)[None],
            valid=valid.any()[None],
            covers=valid[None],
            blame=(taken / jnp.where(total > 0, total, 1.0))[None],
        )
        return score, ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
