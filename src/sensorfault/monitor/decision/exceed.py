"""Fault as soon as a test exceeds its limit; a channel without a new test keeps its verdict for a stated time."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.monitor.decision.accuse import accuse
from sensorfault.types import NEVER, Accusation, Evidence, Trust


class Held(NamedTuple):
    """The last verdict of each channel and when it was tested."""

    named: Bool[Array, " C"]
    when: Float[Array, " C"]


class Exceed(eqx.Module):
    """score > limit, at once."""

    hold_s: Float[Array, " C"]  # how long a verdict stands without a new measurement [s]
    share: float = eqx.field(static=True, default=0.5)

    def init(self) -> Held:
        return Held(jnp.zeros(self.hold_s.shape, bool), jnp.full(self.hold_s.shape, NEVER))

    def evaluate(self, state: Held, evidence: Evidence) -> tuple[Accusation, Held]:
        told = accuse(evidence, self.share)
        return hold(state, evidence, told, self.hold_s)

    def update(self, pending: Held, trust: Trust) -> Held:
        return pending


def hold(state: Held, evidence: Evidence, told: Accusation, hold_s: Float[Array, " C"]) -> tuple[Accusation, Held]:
    """Let a channel that was not tested now keep its last verdict for `hold_s`."""
    standing = ~told.tested & (evidence.time - state.when <= hold_s)
    named = told.named | (standing & state.named)
    held = Held(jnp.where(told.tested, told.named, state.named), jnp.where(told.tested, evidence.time, state.when))
    return told._replace(named=named, tested=told.tested | standing), held
