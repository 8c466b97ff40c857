"""Multi-step observer: a height minus what it should be, rolled out from where it was N measurements ago."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float, Int

from sensorfault.core.types import NEVER, Residual, Sample, Trust
from sensorfault.numerics.columns import picked, shifted
from sensorfault.vehicles.height import Climb, StepNetwork


class Bank(NamedTuple):
    """Each member's residual, rolled out over its own number of steps: measured minus expected."""

    value: Float[Array, " M"]  # [m]
    valid: Bool[Array, " M"]


class _State(NamedTuple):
    height: Float[Array, " L"]  # at the last L fixes, the newest last: measured, or what stood in for it [m]
    inputs: Float[Array, "L U"]  # there [SI]
    time: Float[Array, " L"]  # of them [s]
    whole: Int[Array, ""]  # so many of them, the newest, follow each other without a hole
    origin: Float[Array, ""]  # time of the trusted height from which the newest was rolled out; its own if trusted [s]


class _Work(NamedTuple):
    state: _State
    sample: Sample
    inputs: Float[Array, " U"]
    known: Bool[Array, ""]  # all inputs
    predicted: Bool[Array, ""]  # whether there is a height to expect now
    origin: Float[Array, ""]  # as above, of that height


class MultistepObserver(eqx.Module):
    """r_N(k) = h(k) - ĥ_N(k), with ĥ rolled out from h(k-N) by N steps that feed back their predicted height, and
    the measured inputs. Wang et al., equations (2)-(7); N = 1 is the conventional observer.

    A step leads from one new height to the next. All members of a bank of several N are one computation; their
    residuals stand in `extra`. A height that was not trusted is no starting point: the expected one takes its place,
    for as long as the monitor fills it in. What is expected of the channel is the roll-out of the
    longest member that is ready, which a slow drift has touched least, and from there on, while nothing is trusted,
    what follows from that. Its variance grows with the time since the height that it was rolled out from.

    After a gap of more than `gap_s`, an unknown input, or a height neither trusted nor filled in, the past is void.
    """

    model: Climb | StepNetwork
    steps: Int[Array, " M"]
    ages: Float[Array, " G"]  # of a roll-out [s], rising
    variance: Float[Array, " G"]  # of what is expected after so long, on healthy data [m^2]
    gap_s: Float[Array, ""]
    column: int = eqx.field(static=True)
    longest: int = eqx.field(static=True)  # L, at least the largest of `steps`

    def init(self) -> _State:
        never = jnp.full(self.longest, NEVER, float)
        past = jnp.zeros((self.longest, len(self.model.columns)))
        return _State(jnp.zeros(self.longest), past, never, jnp.zeros((), int), never[0])

    def evaluate(self, state: _State, sample: Sample) -> tuple[Residual, _Work]:
        now, c = sample.time, self.column
        away = now - state.time[-1]
        gone = (away > self.gap_s) | (away <= 0) | sample.born[c]
        state = state._replace(whole=jnp.where(gone, 0, state.whole))
        known = picked(sample.present, self.model.columns).all()
        inputs = jnp.where(known, picked(sample.value, self.model.columns), state.inputs[-1])
        time = jnp.concatenate([state.time, now[None]])
        steps = jnp.concatenate([self.steps, jnp.ones(1, self.steps.dtype)])  # the last goes on from what stands in
        rolled = self.model.rolled(state.height, jnp.concatenate([state.inputs, inputs[None]]), time, steps)
        ready = (state.whole >= steps) & known
        away_from = jnp.where(ready[:-1], self.steps, 0)
        start = time[self.longest - jnp.maximum(away_from.max(), 1)]
        alone = state.origin < state.time[-1]
        origin = jnp.where(alone, state.origin, start)
        expected = jnp.where(alone, rolled[-1], rolled[jnp.argmax(away_from)])
        expected = jnp.where(ready[-1], expected, sample.value[c])
        bank = Bank(jnp.where(ready, sample.value[c] - rolled, 0.0)[:-1], ready[:-1])
        mine = jnp.arange(sample.value.size) == c
        residual = Residual(
            time=now,
            value=jnp.where(mine, sample.value - expected, 0.0),
            cov=jnp.diag(jnp.where(mine, self._variance(now - origin), 1.0)),
            measured=sample.value,
            expected=jnp.where(mine, expected, sample.value),
            noise=jnp.where(mine, self.variance[0], 1.0),
            valid=sample.fresh & mine & bank.valid.any(),
            born=sample.born,
            extra=bank,
        )
        return residual, _Work(state, sample, inputs, known, ready[-1], origin)

    def update(self, pending: _Work, trust: Trust) -> _State:
        state, sample, inputs, known, predicted, origin = pending
        c = self.column
        fix, measured = sample.fresh[c], trust.measured[c]
        new = picked(sample.fresh, self.model.columns)
        taken = picked(trust.measured | trust.filled, self.model.columns)
        whole = (measured | (trust.filled[c] & predicted)) & known & (taken | ~new).all()
        inputs = jnp.where(picked(trust.filled, self.model.columns), picked(trust.value, self.model.columns), inputs)
        after = _State(
            height=shifted(state.height, trust.value[c]),
            inputs=shifted(state.inputs, inputs),
            time=shifted(state.time, sample.time),
            whole=jnp.where(whole, jnp.minimum(state.whole + 1, self.longest), 0),
            origin=jnp.where(measured, sample.time, origin),
        )
        kept = [jnp.where(fix, a, b) for a, b in zip(after, state, strict=True)]
        return _State(*kept)

    def _variance(self, age: Float[Array, ""]) -> Float[Array, ""]:
        """Of what is expected `age` [s] after the last height it was rolled out from [m^2]."""
        beyond = jnp.maximum(age / self.ages[-1], 1.0) ** 2
        within = jnp.interp(age, self.ages, self.variance)
        return within * beyond
