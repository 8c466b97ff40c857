"""Exact repeats: how many new measurements in a row were, to the last bit, the one before."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import Residual, Score, Trust


class _Run(NamedTuple):
    last: Float[Array, " C"]
    known: Bool[Array, " C"]  # whether there was a last
    length: Float[Array, " C"]


class Repeats(eqx.Module):
    """Length of the current run of identical measurements, one test a channel.

    A noisy sensor that repeats itself for long is frozen. Held values are not new measurements and do not count.
    """

    channels: int = eqx.field(static=True)

    def init(self) -> _Run:
        return _Run(jnp.zeros(self.channels), jnp.zeros(self.channels, bool), jnp.zeros(self.channels))

    def evaluate(self, state: _Run, residual: Residual) -> tuple[Score, _Run]:
        valid = residual.valid
        known = state.known & ~residual.born
        same = known & (residual.measured == state.last)
        length = jnp.where(valid, jnp.where(same, state.length + 1, 0.0), jnp.where(known, state.length, 0.0))
        each = jnp.eye(self.channels, dtype=bool)
        score = Score(length, valid, each, each.astype(length.dtype))
        return score, _Run(jnp.where(valid, residual.measured, state.last), known | valid, length)

    def update(self, pending: _Run, trust: Trust) -> _Run:
        return pending
