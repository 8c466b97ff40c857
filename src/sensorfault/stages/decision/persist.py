"""Fault when `needed` of the last `window` tests of a channel exceeded their limits."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Int

from sensorfault.core.types import Accusation, Evidence, Trust
from sensorfault.stages.decision.accuse import accuse


class _Recent(NamedTuple):
    """The last tests, one bit each, the newest lowest: of each channel, and of the sample as a whole."""

    channel: Int[Array, " C"]
    sample: Int[Array, ""]


class Persist(eqx.Module):
    """`needed` of `window` (at most 31): one wild score is not yet a fault."""

    channels: int = eqx.field(static=True)
    needed: int = eqx.field(static=True)
    window: int = eqx.field(static=True)
    share: float = eqx.field(static=True, default=0.5)

    def __check_init__(self) -> None:
        if not 1 <= self.needed <= self.window <= 31:
            raise ValueError(f"persist: needs 1 <= needed <= window <= 31, got {self.needed} of {self.window}")

    def init(self) -> _Recent:
        return _Recent(jnp.zeros(self.channels, jnp.int32), jnp.zeros((), jnp.int32))

    def evaluate(self, state: _Recent, evidence: Evidence) -> tuple[Accusation, _Recent]:
        now = accuse(evidence, self.share)
        mask = (1 << self.window) - 1
        channel = jnp.where(evidence.born, 0, state.channel)
        channel = jnp.where(now.tested, ((channel << 1) | now.named.astype(jnp.int32)) & mask, channel)
        sample = ((state.sample << 1) | now.hit.astype(jnp.int32)) & mask
        sample = jnp.where(now.tested.any(), sample, state.sample)
        named = now.tested & (jnp.bitwise_count(channel) >= self.needed)
        hit = now.tested.any() & (jnp.bitwise_count(sample) >= self.needed)
        told = now._replace(
            named=named,
            gated=named & now.gated,
            certain=named & now.certain,
            size=jnp.where(named, now.size, -jnp.inf),
            unlaid=now.unlaid & hit,
            hit=hit,
        )
        return told, _Recent(channel, sample)

    def update(self, pending: _Recent, trust: Trust) -> _Recent:
        return pending
