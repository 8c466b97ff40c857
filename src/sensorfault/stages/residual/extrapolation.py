"""Extrapolation residual: a new measurement minus the last one, or minus the straight line through the last two."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import NEVER, Residual, Sample, Trust
from sensorfault.numerics.local import wrapped


class _State(NamedTuple):
    last: Float[Array, " C"]  # y [SI]
    slope: Float[Array, " C"]  # (y - y') / (t - t') [SI/s]
    time: Float[Array, " C"]  # t of y [s]
    met: Float[Array, " C"]  # measurements since the channel came (again), 2 at most
    taken: Float[Array, " C"]  # when the channel last came or was stood in for [s]


class _Work(NamedTuple):
    state: _State
    now: Float[Array, ""]


class Extrapolation(eqx.Module):
    """Order 0: y~ = y (persistence); order 1: y~ = y + (y - y') / (t - t') Δt, over the last new trusted measurements.

    The baseline of every predictor. Channels with `watched` False are never valid. Of an `angle` only the difference
    within half a turn counts. After more than `stale_s` without a value to take, a channel starts anew.
    """

    watched: Bool[Array, " C"]
    angle: Bool[Array, " C"]
    cov: Float[Array, "C C"]  # of the residual on healthy data [SI]
    stale_s: Float[Array, " C"]
    order: int = eqx.field(static=True)

    def init(self) -> _State:
        nothing = jnp.zeros_like(self.stale_s)
        never = jnp.full_like(nothing, NEVER)
        return _State(nothing, nothing, never, nothing, never)

    def evaluate(self, state: _State, sample: Sample) -> tuple[Residual, _Work]:
        gone = (sample.time - state.taken > self.stale_s) | (sample.time < state.time)
        state = state._replace(met=jnp.where(gone, 0.0, state.met))
        # y~ = y + (y - y') / (t - t') Δt
        ahead = state.slope * (sample.time - state.time) * self.order
        ready = state.met > self.order
        expected = jnp.where(ready, self._near(state.last + ahead), sample.value)
        residual = Residual(
            time=sample.time,
            value=jnp.where(self.watched, self._near(sample.value - expected), 0.0),
            cov=self.cov,
            measured=sample.value,
            expected=expected,
            noise=(jnp.eye(expected.size) * self.cov).sum(axis=1),
            valid=sample.fresh & self.watched & ready,
            born=sample.born,
        )
        return residual, _Work(state, sample.time)

    def update(self, pending: _Work, trust: Trust) -> _State:
        state, now = pending
        new = trust.measured
        fresh = trust.born | (state.met == 0)
        dt = jnp.maximum(now - state.time, 1e-9)
        slope = jnp.where(fresh, 0.0, self._near(trust.value - state.last) / dt)
        met = jnp.where(fresh, 1.0, jnp.minimum(state.met + 1, 2.0))
        return _State(
            jnp.where(new, trust.value, state.last),
            jnp.where(new, slope, state.slope),
            jnp.where(new, now, state.time),
            jnp.where(new, met, state.met),
            jnp.where(new | trust.filled, now, state.taken),
        )

    def _near(self, value: Float[Array, " C"]) -> Float[Array, " C"]:
        """Angles within half a turn, all else as it is."""
        return jnp.where(self.angle, wrapped(value), value)
