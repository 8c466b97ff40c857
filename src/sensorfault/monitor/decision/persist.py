"""Fault when `needed` of the last `window` tests of a channel exceeded their limits."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float, Int

from sensorfault.monitor.decision.accuse import accuse
from sensorfault.monitor.decision.exceed import Held, hold
from sensorfault.types import NEVER, Accusation, Evidence, Trust


class _Memory(NamedTuple):
    held: Held
    recent: Int[Array, " C"]  # the last tests of the channel, one bit each, the newest lowest


class Persist(eqx.Module):
    """`needed` of `window` (at most 31): one wild score is not yet a fault."""

    hold_s: Float[Array, " C"]
    needed: int = eqx.field(static=True)
    window: int = eqx.field(static=True)
    share: float = eqx.field(static=True, default=0.5)

    def __check_init__(self) -> None:
        if not 1 <= self.needed <= self.window <= 31:
            raise ValueError(f"persist: needs 1 <= needed <= window <= 31, got {self.needed} of {self.window}")

    def init(self) -> _Memory:
        shape = self.hold_s.shape
        held = Held(jnp.zeros(shape, bool), jnp.full(shape, NEVER))
        return _Memory(held, jnp.zeros(shape, jnp.int32))

    def evaluate(self, state: _Memory, evidence: Evidence) -> tuple[Accusation, _Memory]:
        now = accuse(evidence, self.share)
        shifted = ((state.recent << 1) | now.named) & ((1 << self.window) - 1)
        recent = jnp.where(now.tested, shifted, state.recent)
        enough = jnp.bitwise_count(recent) >= self.needed
        named = enough & now.tested
        size = jnp.where(named, now.size, -jnp.inf)
        told, held = hold(
            state.held,
            evidence,
            now._replace(named=named, gated=named & now.gated, size=size, hit=named.any()),
            self.hold_s,
        )
        return told, _Memory(held, recent)

    def update(self, pending: _Memory, trust: Trust) -> _Memory:
        return pending
