"""Difference of two sensors of one quantity: a height against an independent one, averaged from beat to beat."""

from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import NEVER, Residual, Sample, Trust
from sensorfault.numerics.blocks import EARLY


class Beat(NamedTuple):
    """Measured minus reference, its lag left in; how fast the reference moves; `closed`: a beat is over.

    `time`: the mean time of what was measured [s].
    """

    difference: Float[Array, ""]  # [SI]
    speed: Float[Array, ""]  # [SI/s]
    closed: Bool[Array, ""]
    time: Float[Array, ""]


class _Mean(NamedTuple):
    """Of what came since the last beat: values, the sum of them and of their times since that beat."""

    n: Float[Array, ""]
    value: Float[Array, ""]
    time: Float[Array, ""]

    def more(self, new: Bool[Array, ""], value: Float[Array, ""], time: Float[Array, ""]) -> "_Mean":
        return _Mean(
            self.n + new.astype(float),
            self.value + jnp.where(new, value, 0.0),
            self.time + jnp.where(new, time, 0.0),
        )

    def at(self) -> tuple[Float[Array, ""], Float[Array, ""]]:
        """Mean value and mean time."""
        n = jnp.maximum(self.n, 1.0)
        return self.value / n, self.time / n


class _State(NamedTuple):
    start: Float[Array, ""]  # of the beat [s]
    measured: _Mean
    reference: _Mean
    last: Float[Array, ""]  # the reference's mean in the beat before
    at: Float[Array, ""]  # ... and its mean time [s]
    speed: Float[Array, ""]
    offset: Float[Array, ""]
    beats: Float[Array, ""]  # the offset was learned from, `warm` at most
    learned: Float[Array, ""]  # when the offset was last learned [s]


class _Work(NamedTuple):
    state: _State  # carried on to now
    now: Float[Array, ""]
    difference: Float[Array, ""]
    ready: Bool[Array, ""]


class Difference(eqx.Module):
    """e = h - (r + r' (t_h - t_r + lag)) - offset, h, r, t the means of a beat, r' the reference's speed between beats.

    A beat is over with the first fix at least `beat_s` after the one that closed the beat before, so a slow receiver
    sets the beat itself. The lag says how much later the reference shows what both see; without it a climb looks like a
    drift. The speed comes from the reference alone: the measured channel has no part in its own reference. The offset
    is the mean of the first `warm` beats, and then, where `memory_s` is finite, follows trusted differences so slowly:
    a test for slopes wants it constant, a test for offsets wants it to follow what weather does.

    The `measured` channel alone is valid, at the end of a beat. Its expected value is at every tick what the reference
    says, with the offset. After `gap_s` without a beat or without the reference, the next beat only begins anew.
    """

    beat_s: Float[Array, ""]
    lag_s: Float[Array, ""]
    memory_s: Float[Array, ""]
    gap_s: Float[Array, ""]
    variance: Float[Array, ""]  # of e on healthy data [SI²]
    measured: int = eqx.field(static=True)
    reference: int = eqx.field(static=True)
    channels: int = eqx.field(static=True)
    warm: int = eqx.field(static=True, default=10)

    def init(self) -> _State:
        nothing, never = jnp.zeros(()), jnp.asarray(NEVER, float)
        none = _Mean(nothing, nothing, nothing)
        return _State(never, none, none, nothing, never, nothing, nothing, nothing, never)

    def evaluate(self, state: _State, sample: Sample) -> tuple[Residual, _Work]:
        now = sample.time
        new, also = sample.fresh[self.measured], sample.fresh[self.reference]
        state = self._begun(state, now)
        since = now - state.start
        height = state.measured.more(new, sample.value[self.measured], since)
        other = state.reference.more(also, sample.value[self.reference], since)
        closed = new & (since >= (1 - EARLY) * self.beat_s)

        (h, t_h), (r, t_r) = height.at(), other.at()
        t_r = state.start + t_r
        there, before = other.n > 0, now - state.at <= self.gap_s
        dt = t_r - state.at
        speed = jnp.where(there & before & (dt > 0), (r - state.last) / jnp.where(dt > 0, dt, 1.0), state.speed)
        # d = h - (r + r' (t_h - t_r))
        difference = h - (r + speed * (state.start + t_h - t_r))
        ready = closed & there & before
        level = jnp.where(state.beats > 0, state.offset, difference - speed * self.lag_s)
        # e = d - r' lag - offset
        e = difference - speed * self.lag_s - level
        said, at = jnp.where(there, r, state.last), jnp.where(there, t_r, state.at)
        expected = said + speed * (now - at + self.lag_s) + level
        valid = ready & (state.beats >= self.warm)
        nothing = jnp.zeros(())
        none = _Mean(nothing, nothing, nothing)
        over = _State(now, none, none, said, at, speed, state.offset, state.beats, state.learned)
        going = state._replace(measured=height, reference=other)
        carried = jax.tree.map(lambda a, b: jnp.where(closed, a, b), over, going)
        work = _Work(carried, now, difference - speed * self.lag_s, ready)
        return self._residual(
            sample, e, expected, valid, before, Beat(difference, speed, ready, state.start + t_h)
        ), work

    def update(self, work: _Work, trust: Trust) -> _State:
        state = work.state
        learn = work.ready & trust.measured[self.measured]
        first = state.beats < self.warm
        age = jnp.clip(work.now - state.learned, 0.0, self.gap_s)
        gain = jnp.where(first, 1 / (state.beats + 1), 1 - jnp.exp(-age / self.memory_s))
        return state._replace(
            offset=jnp.where(learn, state.offset + gain * (work.difference - state.offset), state.offset),
            beats=jnp.where(learn & first, state.beats + 1, state.beats),
            learned=jnp.where(learn, work.now, state.learned),
        )

    def _begun(self, state: _State, now: Float[Array, ""]) -> _State:
        """A beat that never ends, or a clock that was set back, begins anew."""
        lost = (now - state.start > self.gap_s) | (now < state.start)
        sums = jax.tree.map(lambda x: jnp.where(lost, 0.0, x), (state.measured, state.reference))
        at = jnp.where(now < state.start, NEVER, state.at)
        return state._replace(start=jnp.where(lost, now, state.start), measured=sums[0], reference=sums[1], at=at)

    def _residual(
        self,
        sample: Sample,
        e: Float[Array, ""],
        expected: Float[Array, ""],
        valid: Bool[Array, ""],
        known: Bool[Array, ""],
        beat: Beat,
    ) -> Residual:
        mine = jnp.arange(self.channels) == self.measured
        noise = jnp.where(mine, self.variance, 1.0)
        return Residual(
            time=sample.time,
            value=jnp.where(mine & valid, e, 0.0),
            cov=jnp.eye(self.channels) * noise[None],
            measured=sample.value,
            expected=jnp.where(mine & known, expected, sample.value),
            noise=noise,
            valid=mine & valid,
            born=sample.born,
            extra=beat,
        )
