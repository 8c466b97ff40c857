"""The last seconds of each channel's residual: what the statistics share that look back over a window."""

from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.core.types import NEVER, Residual
from sensorfault.numerics.blocks import Blocks


class Past(NamedTuple):
    """Evidence: it takes every valid sample, trusted or not."""

    blocks: Blocks
    last: Float[Array, " C"]  # when the channel was last valid [s]
    since: Float[Array, " C"]  # when its window began [s]

    @classmethod
    def empty(cls, slots: int, channels: int) -> "Past":
        """Nothing seen yet."""
        never = jnp.full(channels, NEVER, float)
        return cls(Blocks.empty(slots, channels), never, never)

    def taken(
        self,
        residual: Residual,
        value: Float[Array, " C"],
        weight: Float[Array, " C"],
        spacing: Float[Array, ""],
        gap_s: Float[Array, ""],
    ) -> "Past":
        """With these values where the residual is valid.

        A channel that was not valid for longer than `gap_s`, or now carries another source, begins anew.
        """
        valid, time = residual.valid, residual.time
        broken = (time - self.last > gap_s) | (time < self.last) | residual.born
        blocks = self.blocks.kept(~(valid & broken)).put(valid, jnp.where(valid, value, 0.0), weight, time, spacing)
        return Past(blocks, jnp.where(valid, time, self.last), jnp.where(valid & broken, time, self.since))
