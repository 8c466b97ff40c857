"""A test on the last seconds of each channel's residual: the window is kept here, what is measured of it is a part."""

from typing import NamedTuple, Protocol, runtime_checkable

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.monitor.statistic.each import each
from sensorfault.numerics.blocks import EARLY, Blocks, Window, window
from sensorfault.types import NEVER, Residual, Score, Trust


@runtime_checkable
class Measure(Protocol):
    """One number of each channel's window, at least 0."""

    def __call__(self, seen: Window) -> Float[Array, " C"]: ...


class _Past(NamedTuple):
    blocks: Blocks
    last: Float[Array, " C"]  # when the channel was last valid [s]
    since: Float[Array, " C"]  # when its window began [s]


class Windowed(eqx.Module):
    """`measure` of each channel's valid residuals over `window_s`; it accuses that channel alone.

    The window holds `slots` blocks, so a sample costs a look at the blocks, however fast the channel; values further
    apart than about 1.2 `window_s` over their number have a block each. It is evidence: it takes every valid sample,
    trusted or not, and is judged once it is full. A channel that was not valid for longer than `gap_s`, or now carries
    another source, fills its window anew. Weights are 1 / S, S the channel's variance in `residual.cov`.
    """

    measure: Measure
    window_s: Float[Array, ""]
    gap_s: Float[Array, ""]
    channels: int = eqx.field(static=True)
    slots: int = eqx.field(static=True)

    def init(self) -> _Past:
        never = jnp.full(self.channels, NEVER, float)
        return _Past(Blocks.empty(self.slots, self.channels), never, never)

    def evaluate(self, state: _Past, residual: Residual) -> tuple[Score, _Past]:
        valid, time = residual.valid, residual.time
        spacing = self.window_s / ((1 - EARLY) * self.slots - 2)
        broken = (time - state.last > self.gap_s) | (time < state.last) | residual.born
        since = jnp.where(valid & broken, time, state.since)
        variance = (jnp.eye(self.channels) * residual.cov).sum(axis=1)
        value = jnp.where(valid, residual.value, 0.0)
        blocks = state.blocks.kept(~(valid & broken)).put(valid, value, 1 / variance, time, spacing)
        full = valid & (time - since >= self.window_s - 1.5 * spacing)
        after = _Past(blocks, jnp.where(valid, time, state.last), since)
        return each(self.measure(window(blocks, self.window_s)), full), after

    def update(self, pending: _Past, trust: Trust) -> _Past:
        return pending
