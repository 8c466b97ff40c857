"""The largest healthy score, scaled by a factor that shrinks as the score grows."""

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.core.types import Residual, Score, Trust


class ScaledMax(eqx.Module):
    """delta = gamma max(error), gamma = 1 + 1 / (1 + exp(score)): Min et al. 2021, equations (10) and (11).

    The limit follows the score it judges, yet decides as one fixed limit would: score - delta(score) rises with the
    score, so the rule fires above the one root of e = max(error) (1 + 1 / (1 + exp(e))), given by `fixed_point`.
    """

    largest: Float[Array, " K"]

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], seen: tuple[Residual, Score]) -> tuple[Float[Array, " K"], tuple[()]]:
        _, score = seen
        # (11) gamma = 1 + 1 / (1 + e^score)
        gamma = 1.0 + jax.nn.sigmoid(-score.value)
        # (10) delta = gamma max(err)
        return gamma * self.largest, ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()

    def fixed_point(self) -> Float[Array, " K"]:
        """The fixed limit that decides as this rule does, by bisection of [max, 1.5 max]."""
        low, high = self.largest, 1.5 * self.largest
        for _ in range(60):
            middle = (low + high) / 2
            above = middle > self.largest * (1.0 + jax.nn.sigmoid(-middle))
            low, high = jnp.where(above, low, middle), jnp.where(above, middle, high)
        return high
