"""No limit at all: how scores are looked at while limits are fitted."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.core.types import Residual, Score, Trust


class Off(eqx.Module):
    """+inf for every test, however many there are."""

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], seen: tuple[Residual, Score]) -> tuple[Float[Array, " K"], tuple[()]]:
        _, score = seen
        return jnp.full_like(score.value, jnp.inf), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
