"""Means of each channel's normalised innovation over several windows that end now."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.core.types import Residual
from sensorfault.numerics.blocks import Blocks
from sensorfault.stages.statistic.past import Past


class Means(eqx.Module):
    """For each window the mean of z_i / √S_ii over its last `length_s` seconds, in units of its healthy `spread`.

    What comes less than `spacing_s` apart shares a block. A window that is not yet full counts what it lacks as zero,
    so that one innovation does not weigh like thirty, and a satellite is judged from its first on. Missing epochs
    within a window are left out. A channel that was not valid for longer than `gap_s`, or now carries another source,
    begins anew.
    """

    length_s: Float[Array, " W"]
    spread: Float[Array, " W"]
    spacing_s: Float[Array, ""]
    gap_s: Float[Array, ""]
    channels: int = eqx.field(static=True)
    slots: int = eqx.field(static=True)

    def init(self) -> Past:
        return Past.empty(self.slots, self.channels)

    def over(self, past: Past, residual: Residual) -> tuple[Float[Array, "C W"], Past]:
        """The means, and the past with this residual in it."""
        own = jnp.eye(self.channels)
        e = residual.value / jnp.sqrt((own * residual.cov).sum(axis=1))
        after = past.taken(residual, e, jnp.ones(self.channels), self.spacing_s, self.gap_s)
        share = (residual.time - after.since + self.spacing_s)[:, None] / self.length_s[None]
        mean = _means(after.blocks, self.length_s - self.spacing_s / 2)
        return mean * jnp.clip(share, 0.0, 1.0) / self.spread[None], after


def _means(blocks: Blocks, length: Float[Array, " W"]) -> Float[Array, "C W"]:
    """Of the values no older than each length [s] before the newest."""
    age = blocks.newest[None] - blocks.time
    n = jnp.where(age[:, :, None] <= length[None, None], blocks.n[:, :, None], 0.0)
    return (n * blocks.value[:, :, None]).sum(axis=0) / jnp.maximum(n.sum(axis=0), 1.0)
