"""Exact repeats: how many new measurements in a row were, to the last bit, the one before."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.types import Residual, Score, Trust


class _Run(NamedTuple):
    last: Float[Array, " C"]
    length: Float[Array, " C"]


class Repeats(eqx.Module):
    """Length of the current run of identical measurements, one test a channel.

    A noisy sensor that repeats itself for long is jammed. Held values are not new measurements and do not count.
    """

    channels: int = eqx.field(static=True)

    def init(self) -> _Run:
        return _Run(jnp.zeros(self.channels), jnp.zeros(self.channels))

    def evaluate(self, state: _Run, residual: Residual) -> tuple[Score, _Run]:
        same = (residual.measured == state.last) & ~residual.born
        length = jnp.where(residual.valid, jnp.where(same, state.length + 1, 0.0), state.length)
        each = jnp.eye(self.channels, dtype=bool)
        score = Score(length, residual.valid, each, each.astype(length.dtype))
        return score, _Run(jnp.where(residual.valid, residual.measured, state.last), length)

    def update(self, pending: _Run, trust: Trust) -> _Run:
        return pending
