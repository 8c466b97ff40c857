"""Two heights of one vehicle: each expected where the other one is, plus their recent difference."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import NEVER, Residual, Sample, Trust


class Spoken(NamedTuple):
    """What every channel says now, for statistics that compare more than the two heights. As in Sample."""

    fresh: Bool[Array, " C"]
    present: Bool[Array, " C"]


class _State(NamedTuple):
    offset: Float[Array, ""]  # the first height minus the second [m]
    learned: Float[Array, ""]  # when it was last learned [s]
    beats: Float[Array, ""]  # it was learned from, `warm` at most


class _Work(NamedTuple):
    state: _State
    time: Float[Array, ""]
    difference: Float[Array, ""]
    both: Bool[Array, ""]


class TwoHeights(eqx.Module):
    """r = h - (h' + offset) and the same for h'; the offset follows what is believed of both over `memory_s`.

    It is learned when the first height is new. Its variance is `variance` where it is, and grows by as much in every
    `memory_s` after. Without two heights nothing is expected of anything.
    """

    memory_s: Float[Array, ""]
    variance: Float[Array, ""]  # of r on healthy data [m^2]
    heights: tuple[int, ...] = eqx.field(static=True)  # two columns, or fewer
    watched: tuple[int, ...] = eqx.field(static=True)  # columns of all witnesses of the height
    channels: int = eqx.field(static=True)
    warm: int = eqx.field(static=True, default=10)

    def init(self) -> _State:
        return _State(jnp.zeros(()), jnp.asarray(NEVER), jnp.zeros(()))

    def evaluate(self, state: _State, sample: Sample) -> tuple[Residual, _Work]:
        columns = jnp.arange(self.channels)
        expected, known = sample.value, jnp.zeros(self.channels, bool)
        difference, both = jnp.zeros(()), jnp.zeros((), bool)
        if len(self.heights) == 2:
            first, second = self.heights
            there = sample.present[first] & sample.present[second]
            difference, both = sample.value[first] - sample.value[second], there & sample.fresh[first]
            for mine, other, sign in ((first, second, 1.0), (second, first, -1.0)):
                good = (columns == mine) & sample.present[other] & (state.beats >= self.warm)
                # ĥ = h' + (h - h'), as it was when both were believed
                expected = jnp.where(good, sample.value[other] + sign * state.offset, expected)
                known = known | good
        watched = jnp.asarray([c in self.watched for c in range(self.channels)])
        age = jnp.where(state.beats > 0, (sample.time - state.learned) / self.memory_s, 0.0)
        variance = jnp.where(known, self.variance * (1 + age), 1.0)
        residual = Residual(
            time=sample.time,
            value=sample.value - expected,
            cov=jnp.diag(variance),
            measured=sample.value,
            expected=expected,
            noise=variance,
            valid=sample.fresh & watched,
            born=sample.born,
            extra=Spoken(sample.fresh, sample.present),
        )
        return residual, _Work(state, sample.time, difference, both)

    def update(self, work: _Work, trust: Trust) -> _State:
        state = work.state
        if len(self.heights) < 2:
            return state
        first, second = self.heights
        born = trust.born[first] | trust.born[second]
        state = state._replace(beats=jnp.where(born, 0.0, state.beats))
        new = state.beats < self.warm
        judged = trust.learn[first] & ~(trust.filled[second] | born)
        learn = work.both & jnp.where(new, trust.measured[first] & ~trust.filled[second], judged)
        gain = jnp.where(new, 1 / (state.beats + 1), 1 - jnp.exp((state.learned - work.time) / self.memory_s))
        moved = state.offset + jnp.clip(gain, 0.0, 1.0) * (work.difference - state.offset)
        return _State(
            offset=jnp.where(learn, moved, state.offset),
            learned=jnp.where(learn, work.time, state.learned),
            beats=jnp.where(learn & new, state.beats + 1, state.beats),
        )
