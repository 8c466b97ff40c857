"""Page's cumulative sum: small offsets add up, noise does not."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.core.types import NEVER, Residual, Score, Trust
from sensorfault.stages.statistic.per_channel import each


class _Sums(NamedTuple):
    up: Float[Array, " C"]
    down: Float[Array, " C"]
    last: Float[Array, " C"]  # when the channel was last valid [s]


class Cusum(eqx.Module):
    """max(g⁺, g⁻) of each channel, g± = max(0, g± ± e/√S - k). Page 1954.

    `allowance` k: half the offset that is to be found, in standard deviations. A sum is evidence, so it takes every
    valid sample; it stops at `ceiling`, so that a long fault does not alarm long after its end. It begins anew when
    its channel was not valid for longer than `gap_s` or carries another source.
    """

    allowance: Float[Array, " C"]
    ceiling: Float[Array, " C"]
    gap_s: Float[Array, ""]

    def init(self) -> _Sums:
        nothing = jnp.zeros_like(self.allowance)
        return _Sums(nothing, nothing, jnp.full_like(nothing, NEVER))

    def evaluate(self, state: _Sums, residual: Residual) -> tuple[Score, _Sums]:
        valid, time = residual.valid, residual.time
        broken = (time - state.last > self.gap_s) | (time < state.last) | residual.born
        sigma = jnp.sqrt((jnp.eye(valid.size) * residual.cov).sum(axis=1))
        e = jnp.where(valid, residual.value, 0.0) / sigma
        up, down = (jnp.where(broken, 0.0, g) for g in (state.up, state.down))
        # g± ← max(0, g± ± e - k)
        up = jnp.clip(up + e - self.allowance, 0.0, self.ceiling)
        down = jnp.clip(down - e - self.allowance, 0.0, self.ceiling)
        after = _Sums(
            jnp.where(valid, up, state.up), jnp.where(valid, down, state.down), jnp.where(valid, time, state.last)
        )
        return each(jnp.maximum(up, down), valid), after

    def update(self, pending: _Sums, trust: Trust) -> _Sums:
        return pending
