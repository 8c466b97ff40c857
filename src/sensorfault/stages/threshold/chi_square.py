"""The quantile of χ² for as many channels as a test has examined."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.core.types import Residual, Score, Trust


class ChiSquare(eqx.Module):
    """√χ²(m) at a false-alarm rate, m the channels that the test covers: satellites come and go. Of a score √q.

    `limit[m - 1]` is the limit for m, of calibration/chi_square.py. Without a channel there is nothing to limit.
    """

    limit: Float[Array, " C"]

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], seen: tuple[Residual, Score]) -> tuple[Float[Array, " K"], tuple[()]]:
        many = seen[1].covers.sum(axis=1)
        mine = many[:, None] == jnp.arange(1, self.limit.size + 1)[None]
        return jnp.where(mine, self.limit[None], 0.0).sum(axis=1), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
