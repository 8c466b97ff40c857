"""Put the expected value in the place of a faulty one, for as long as it may be believed."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import NEVER, Residual, Sample, Trust, Verdict
from sensorfault.core.verdicts import FAULT, OK


class _Since(NamedTuple):
    healthy: Float[Array, " C"]  # when the channel was last trusted [s]
    accused: Float[Array, " C"]  # when it was last kept out [s]


class Rebuild(eqx.Module):
    """Stand-in = expected value, up to `horizon_s` after the last trusted measurement; one for all or one a channel.

    A channel is trusted again `readmit_s` after the last accusation: a score that dips below its limit
    for a moment does not make a fault healthy.
    """

    horizon_s: Float[Array, "*C"]
    readmit_s: Float[Array, "*C"]
    channels: int = eqx.field(static=True)

    def init(self) -> _Since:
        return _Since(jnp.full(self.channels, NEVER, float), jnp.full(self.channels, NEVER, float))

    def evaluate(
        self, state: _Since, seen: tuple[Sample, Residual, Verdict, Bool[Array, " C"]]
    ) -> tuple[Trust, _Since]:
        sample, residual, verdict, gated = seen
        accused = jnp.where(gated, sample.time, state.accused)
        doubted = sample.time - accused <= self.readmit_s
        held = ~sample.fresh & sample.present & (verdict.channel == FAULT) & (state.accused >= state.healthy)
        doubted = doubted | held
        measured = sample.fresh & ~doubted
        filled = doubted & sample.present & (sample.time - state.healthy <= self.horizon_s)
        trust = Trust(
            value=jnp.where(filled, residual.expected, sample.value),
            measured=measured,
            filled=filled,
            learn=measured & (verdict.channel == OK) & (verdict.sample == OK),
            born=sample.born,
        )
        return trust, _Since(jnp.where(measured, sample.time, state.healthy), accused)

    def update(self, pending: _Since, trust: Trust) -> _Since:
        return pending
