"""Leave a faulty measurement out, and take it in again only after it has been healthy for a while."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import NEVER, OK, Residual, Sample, Trust, Verdict


class _Doubt(NamedTuple):
    doubted: Bool[Array, " C"]
    healthy: Float[Array, " C"]  # since when its tests have been under their limits, without a break [s]
    tested: Float[Array, " C"]  # when it was last seen healthy [s]


class Readmit(eqx.Module):
    """A filter takes in what is fresh and not accused, nor was so in the last `readmit_s` of its being seen.

    A fault that is about as large as its limit is over it at one epoch and under it at the next: each time that it is
    taken in, the filter moves towards it. Only tests passed count: a satellite that is accused and then hidden for a
    minute is as suspect as before, and one not seen for longer than `gap_s` begins its time anew. Another source in the
    slot is not on trial. What is out is judged at every epoch against a filter without it, so it can always come back.
    """

    readmit_s: Float[Array, ""]
    gap_s: Float[Array, ""]
    channels: int = eqx.field(static=True)

    def init(self) -> _Doubt:
        never = jnp.full(self.channels, NEVER, float)
        return _Doubt(jnp.zeros(self.channels, bool), never, never)

    def evaluate(
        self, state: _Doubt, seen: tuple[Sample, Residual, Verdict, Bool[Array, " C"]]
    ) -> tuple[Trust, _Doubt]:
        sample, residual, verdict, gated = seen
        time = sample.time
        passed = residual.valid & ~gated
        broken = (time - state.tested > self.gap_s) | (time < state.tested)
        healthy = jnp.where(passed & broken, time, state.healthy)
        old = state.doubted & ~sample.born
        doubted = gated | (old & ~(passed & (time - healthy >= self.readmit_s)))
        measured = sample.fresh & ~doubted
        learn = measured & (verdict.channel == OK) & (verdict.sample == OK)
        # an accusation breaks the time of health
        tested = jnp.where(gated, NEVER, jnp.where(passed, time, state.tested))
        return Trust(sample.value, measured, gated & False, learn, sample.born), _Doubt(doubted, healthy, tested)

    def update(self, pending: _Doubt, trust: Trust) -> _Doubt:
        return pending
