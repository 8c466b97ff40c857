"""Jarque and Bera's test on a sliding window of normalised innovations, with the mean and variance it is blind to."""

from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import NEVER, Residual, Score, Trust
from sensorfault.numerics.moments import Moments, joined, nothing, together

WILDEST = 30.0  # standard deviations; what lies farther out counts as this, so that fourth powers hide no others


class _Window(NamedTuple):
    blocks: Moments  # [block, channel], the newest last
    start: Float[Array, ""]  # of the newest block [s]
    skipped: Float[Array, " W"]  # valid samples since the last one taken
    last: Float[Array, " W"]  # the last one taken
    known: Bool[Array, " W"]  # whether there was one


class Normality(eqx.Module):
    """Three tests for each watched channel, on the last `window_s`: is e / √S normal, centred, as wide as when healthy?

    JB = n/6 (S² + (K - 3)²/4), Min et al. 2021, equations (24)-(26); √n |mean| / σ; √(n/2) ln(variance / σ²), where
    above 0 (a car at rest is measured better than one under way, which is no fault). JB does not change under a
    constant bias or a scale, so it is never alone. Its quantiles hold for independent samples: healthy innovations are
    correlated, so each `every`-th sample is taken, less `memory` times the one before (an autoregression of first
    order). σ is the healthy standard deviation of what is taken.

    The window is made of blocks with moments of their own, so a sample costs one block and a sum over blocks, and
    nothing cancels over hours. It takes every valid sample, trusted or not, and is judged once it holds `least`.
    """

    watched: tuple[int, ...] = eqx.field(static=True)
    channels: int = eqx.field(static=True)
    memory: Float[Array, " W"]
    sigma: Float[Array, " W"]
    least: Float[Array, " W"]
    every: Float[Array, " W"]
    window_s: Float[Array, ""]
    blocks: int = eqx.field(static=True, default=20)

    def init(self) -> _Window:
        width = len(self.watched)
        empty = nothing(self.blocks, width)
        nil = jnp.zeros(width)
        return _Window(empty, jnp.asarray(NEVER, float), self.every, nil, jnp.zeros(width, bool))

    def evaluate(self, state: _Window, residual: Residual) -> tuple[Score, _Window]:
        state = self._turned(state, residual.time)
        valid = jnp.stack([residual.valid[c] for c in self.watched])
        e = jnp.stack([residual.value[c] / jnp.sqrt(residual.cov[c, c]) for c in self.watched])
        e = jnp.where(valid, jnp.clip(e, -WILDEST, WILDEST), 0.0)
        taken = valid & (state.skipped >= self.every - 1)
        # u_t = (w_t - a w_{t-1}) / √(1 - a²)
        u = (e - self.memory * state.last) / jnp.sqrt(1 - self.memory**2)
        newest = jax.tree.map(lambda x: x[-1], state.blocks)
        more = joined(newest, jnp.where(taken, u, 0.0))
        newest = jax.tree.map(lambda new, old: jnp.where(taken & state.known, new, old), more, newest)
        blocks = jax.tree.map(lambda x, y: jnp.concatenate([x[:-1], y[None]]), state.blocks, newest)
        after = _Window(
            blocks,
            state.start,
            jnp.where(taken, 0.0, state.skipped + valid.astype(float)),
            jnp.where(taken, e, state.last),
            state.known | taken,
        )
        return self._score(together(blocks), valid), after

    def update(self, pending: _Window, trust: Trust) -> _Window:
        return pending

    def _turned(self, state: _Window, time: Float[Array, ""]) -> _Window:
        """A new block when the newest is full; all anew when the clock has left out more than one."""
        length = self.window_s / self.blocks
        age = time - state.start
        turns, fresh = (age >= length) & (age < 2 * length), (age < 0) | (age >= 2 * length)
        empty = nothing(self.blocks, len(self.watched))

        def next_block(x: Float[Array, "B W"], nil: Float[Array, "B W"]) -> Float[Array, "B W"]:
            return jnp.where(fresh, nil, jnp.where(turns, jnp.concatenate([x[1:], nil[:1]]), x))

        start = jnp.where(fresh, time, jnp.where(turns, state.start + length, state.start))
        blocks = jax.tree.map(next_block, state.blocks, empty)
        return state._replace(blocks=blocks, start=start, known=state.known & ~fresh)

    def _score(self, window: Moments, valid: Bool[Array, " W"]) -> Score:
        n = jnp.maximum(window.n, 1.0)
        variance = window.m2 / n
        spread = jnp.where(variance > 0, variance, 1.0)
        # (25) S = μ3 / σ³,  (26) K = μ4 / σ⁴
        skewness, kurtosis = window.m3 / n / spread**1.5, window.m4 / n / spread**2
        # (24) JB = n/6 (S² + (K - 3)²/4)
        normal = n / 6 * (skewness**2 + (kurtosis - 3) ** 2 / 4)
        centred = jnp.sqrt(n) * jnp.abs(window.mean) / self.sigma
        wide = jnp.sqrt(n / 2) * jnp.maximum(jnp.log(spread / self.sigma**2), 0.0)
        full = valid & (window.n >= self.least) & (variance > 0)
        each = jnp.arange(self.channels)[None] == jnp.asarray(self.watched)[:, None]
        covers = jnp.concatenate([each & full[:, None]] * 3)
        return Score(
            jnp.concatenate([normal, centred, wide]), jnp.concatenate([full] * 3), covers, covers.astype(float)
        )
