"""Exponentially weighted moving average of the normalised residual."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.core.types import NEVER, Residual, Score, Trust
from sensorfault.stages.statistic.per_channel import each


class _Average(NamedTuple):
    mean: Float[Array, " C"]
    variance: Float[Array, " C"]
    last: Float[Array, " C"]  # when the channel was last valid [s]


class Ewma(eqx.Module):
    """|y| / √(variance of y) of each channel, y ← y + λ (e/√S - y). Roberts 1959.

    λ = 1 - exp(-Δt / `memory_s`), so that fixes which come irregularly are forgotten by time, not by number; at the
    first of a channel λ = 1. The variance is that of white noise. It takes every valid sample, and begins anew when its
    channel was not valid for longer than `gap_s` or carries another source.
    """

    memory_s: Float[Array, " C"]
    gap_s: Float[Array, ""]

    def init(self) -> _Average:
        nothing = jnp.zeros_like(self.memory_s)
        return _Average(nothing, nothing, jnp.full_like(nothing, NEVER))

    def evaluate(self, state: _Average, residual: Residual) -> tuple[Score, _Average]:
        valid, time = residual.valid, residual.time
        dt = time - state.last
        anew = (dt > self.gap_s) | (dt < 0) | residual.born
        sigma = jnp.sqrt((jnp.eye(valid.size) * residual.cov).sum(axis=1))
        e = jnp.where(valid, residual.value, 0.0) / sigma
        gain = jnp.where(anew, 1.0, 1 - jnp.exp(-jnp.clip(dt, 0.0, self.gap_s) / self.memory_s))
        # y ← y + λ (e - y),  var ← (1 - λ)² var + λ²
        mean = state.mean + gain * (e - state.mean)
        variance = (1 - gain) ** 2 * state.variance + gain**2
        after = _Average(
            jnp.where(valid, mean, state.mean),
            jnp.where(valid, variance, state.variance),
            jnp.where(valid, time, state.last),
        )
        return each(jnp.abs(mean) / jnp.sqrt(jnp.maximum(variance, 1e-12)), valid), after

    def update(self, pending: _Average, trust: Trust) -> _Average:
        return pending
