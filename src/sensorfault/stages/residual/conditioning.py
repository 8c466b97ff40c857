"""Conditioning residual: a sample minus its expectation given the few before it."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import NEVER, Residual, Sample, Trust


class _Window(NamedTuple):
    rows: Float[Array, "W C"]  # the newest first [SI]
    seen: Float[Array, " C"]  # when each channel was last measured and trusted [s]
    filled: Float[Array, " C"]  # rows of its window since it began (anew), W at most


class _Work(NamedTuple):
    window: _Window
    time: Float[Array, ""]
    value: Float[Array, " C"]
    bounded: Float[Array, " C"]


class Conditioning(eqx.Module):
    """e = x_t - E[x_t | x_t-1 .. x_t-W] for jointly Gaussian rows, with the conditional covariance.

    The window takes measured values within `bound` conditional sigmas of what was expected: a spike too small to be
    named would otherwise spoil the next W rows. Where a channel is not trusted, its stand-in or, failing that, its
    last trusted value takes its place, and counts for less with time: its variance grows by `drift` [SI^2/s] up to
    `most` [SI^2], which its weight in the window passes on to the others. So a start, a gap in the clock and a long
    fault all end alike: the first value after them is accepted if the channel was ever like that, and fills its window.
    How it moves is known only after W more rows; until then it is not valid.
    """

    weights: Float[Array, "C WC"]  # of the rows of the window, the newest first
    center: Float[Array, " C"]  # [SI]
    cov: Float[Array, "C C"]  # of x_t given the window [SI]
    drift: Float[Array, " C"]
    most: Float[Array, " C"]
    tick_s: Float[Array, ""]
    bound: Float[Array, ""]
    watched: Bool[Array, " C"]
    lags: int = eqx.field(static=True)

    def init(self) -> _Window:
        shape = self.center.shape
        return _Window(jnp.tile(self.center, (self.lags, 1)), jnp.full(shape, NEVER, float), jnp.zeros(shape))

    def evaluate(self, window: _Window, sample: Sample) -> tuple[Residual, _Work]:
        seen = jnp.where(sample.born, NEVER, window.seen)
        value = jnp.where(sample.present, sample.value, window.rows[0])
        # E[x_t | window] = m + sum_j A_j (x_t-j - m)
        copy = self.weights @ (window.rows - self.center[None]).ravel() + self.center
        expected = jnp.where(self.watched, copy, window.rows[0])
        # One unknown offset d on all of a channel's window moves the expectation by (sum_j A_j) d.
        reach = self.weights.reshape(-1, self.lags, len(value)).sum(axis=1)
        late = jnp.maximum(sample.time - seen - 1.5 * self.tick_s, 0.0)
        unsure = jnp.minimum(self.drift * late, self.most)
        # S + B diag(v) B', as a sum: a matrix product would keep the loop around it from being one function
        cov = self.cov + ((reach * unsure[None])[:, None] * reach[None]).sum(axis=2)
        variance = (jnp.eye(len(value)) * cov).sum(axis=1)
        e = jnp.where(self.watched, value - expected, 0.0)
        most = self.bound * jnp.sqrt(variance)
        known = window.filled >= self.lags
        residual = Residual(
            time=sample.time,
            value=e,
            cov=cov,
            measured=value,
            expected=expected,
            noise=variance,
            valid=sample.fresh & self.watched & known,
            born=sample.born,
        )
        bounded = jnp.where(self.watched & known, expected + jnp.clip(e, -most, most), value)
        return residual, _Work(window._replace(seen=seen), sample.time, value, bounded)

    def update(self, pending: _Work, trust: Trust) -> _Window:
        (rows, seen, filled), time, value, bounded = pending
        # Nothing measured is left in the channel's window (or the clock went back): begin it anew.
        away = time - seen
        anew = trust.measured & ((away > (self.lags + 0.5) * self.tick_s) | (away < 0))
        newest = jnp.where(trust.measured, bounded, jnp.where(trust.filled, trust.value, rows[0]))
        shifted = jnp.where(self.watched[None], jnp.concatenate([newest[None], rows[:-1]]), rows)
        return _Window(
            rows=jnp.where((anew & self.watched)[None], value[None], shifted),
            seen=jnp.where(trust.measured, time, seen),
            filled=jnp.where(anew, 1.0, jnp.where(filled > 0, jnp.minimum(filled + 1, self.lags), 0.0)),
        )
