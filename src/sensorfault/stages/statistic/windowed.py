"""A test on the last seconds of each channel's residual: the window is kept here, what is measured of it is a part."""

from typing import Protocol, runtime_checkable

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.core.types import Residual, Score, Trust
from sensorfault.numerics.blocks import Window, spacing, window
from sensorfault.stages.statistic.past import Past
from sensorfault.stages.statistic.per_channel import each


@runtime_checkable
class Measure(Protocol):
    """One number of each channel's window, at least 0."""

    def __call__(self, seen: Window) -> Float[Array, " C"]: ...


class Windowed(eqx.Module):
    """`measure` of each channel's valid residuals over `window_s`; it accuses that channel alone.

    The window holds `slots` blocks, so a sample costs a look at the blocks, however fast the channel; values further
    apart than about 1.2 `window_s` over their number have a block each. It is evidence: it takes every valid sample,
    trusted or not, and is judged once it is full, or with `early` from its first sample on. A channel that was not
    valid for longer than `gap_s`, or now carries another source, fills its window anew. Weights are 1 / S, S the
    channel's variance in `residual.cov`.
    """

    measure: Measure
    window_s: Float[Array, ""]
    gap_s: Float[Array, ""]
    channels: int = eqx.field(static=True)
    slots: int = eqx.field(static=True)
    early: bool = eqx.field(static=True, default=False)

    def init(self) -> Past:
        return Past.empty(self.slots, self.channels)

    def evaluate(self, state: Past, residual: Residual) -> tuple[Score, Past]:
        apart = spacing(self.window_s, self.slots)
        variance = (jnp.eye(self.channels) * residual.cov).sum(axis=1)
        after = state.taken(residual, residual.value, 1 / variance, apart, self.gap_s)
        full = self.early | (residual.time - after.since >= self.window_s - 1.5 * apart)
        return each(self.measure(window(after.blocks, self.window_s)), residual.valid & full), after

    def update(self, pending: Past, trust: Trust) -> Past:
        return pending
