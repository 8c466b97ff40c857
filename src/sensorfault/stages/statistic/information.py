"""What the innovations of a window say together: sums of their information, for satellites that come and go."""

from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import NEVER, Residual
from sensorfault.numerics.blocks import EARLY, spacing
from sensorfault.numerics.gaussian import precision


class Summed(NamedTuple):
    """ΣS⁻¹ and ΣS⁻¹z over a window, of the channels valid now."""

    matrix: Float[Array, "C C"]
    vector: Float[Array, " C"]


class Information(NamedTuple):
    """K blocks of sums, the newest last, and when each began [s]. Evidence: it takes every valid sample."""

    matrix: Float[Array, "K C C"]
    vector: Float[Array, "K C"]
    start: Float[Array, " K"]

    @classmethod
    def empty(cls, slots: int, channels: int) -> "Information":
        """Nothing seen yet."""
        nothing = jnp.zeros((slots, channels, channels))
        return cls(nothing, nothing[:, 0], jnp.full(slots, NEVER, float))

    def taken(self, residual: Residual, window_s: Float[Array, ""]) -> tuple[Summed, "Information"]:
        """With this sample in it, and what the last `window_s` say. Nothing is known of a channel before it was born.

        S⁻¹ is that of the channels valid at its time: the others are marginalised out.
        """
        valid, time = residual.valid, residual.time
        inverse = precision(residual.cov, valid)
        pull = (inverse * jnp.where(valid, residual.value, 0.0)[None]).sum(axis=1)
        since = time - self.start[-1]
        begins = (since >= (1 - EARLY) * spacing(window_s, len(self.start))) | (since < 0)
        still = ~residual.born & (since >= 0)
        known = still[:, None] & still[None]
        matrix = _put(jnp.where(known[None], self.matrix, 0.0), inverse, begins)
        vector = _put(jnp.where(still[None], self.vector, 0.0), pull, begins)
        start = jnp.where(begins, jnp.concatenate([self.start[1:], time[None]]), self.start)
        recent = time - start <= window_s
        both = valid[:, None] & valid[None]
        summed = Summed(
            jnp.where(both, jnp.where(recent[:, None, None], matrix, 0.0).sum(axis=0), 0.0),
            jnp.where(valid, jnp.where(recent[:, None], vector, 0.0).sum(axis=0), 0.0),
        )
        return summed, Information(matrix, vector, start)


def _put(blocks: Float[Array, "K *s"], new: Float[Array, "*s"], begins: Bool[Array, ""]) -> Float[Array, "K *s"]:
    """Added to the newest block, or as the first of another."""
    shifted = jnp.concatenate([blocks[1:], new[None]])
    added = jnp.concatenate([blocks[:-1], (blocks[-1] + new)[None]])
    return jnp.where(begins, shifted, added)
