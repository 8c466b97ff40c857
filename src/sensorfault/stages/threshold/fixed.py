"""A limit that stays where it was put."""

import equinox as eqx
from jaxtyping import Array, Float

from sensorfault.core.types import Residual, Score, Trust


class Fixed(eqx.Module):
    """One constant limit a test. +inf silences the test, -inf makes it alarm at every sample."""

    limit: Float[Array, " K"]

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], seen: tuple[Residual, Score]) -> tuple[Float[Array, " K"], tuple[()]]:
        return self.limit, ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
