"""The newest part of a window against its oldest part."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.numerics.blocks import Window


class MeanPair(eqx.Module):
    """|mean of the newest `share` of the window - mean of its oldest `share`|, channel by channel [SI].

    What lies between the two parts is left out: there a drift has begun and is not yet big.
    """

    share: Float[Array, ""]

    def __call__(self, seen: Window) -> Float[Array, " C"]:
        part = self.share * seen.length
        newest, oldest = seen.age < part, seen.age > seen.length - part
        (a, there), (b, then) = _mean(seen, newest), _mean(seen, oldest)
        return jnp.where(there & then, jnp.abs(a - b), 0.0)


def _mean(seen: Window, part: Bool[Array, "K C"]) -> tuple[Float[Array, " C"], Bool[Array, " C"]]:
    """Mean of a part, and whether there is anything in it."""
    weight = jnp.where(part, seen.weight, 0.0)
    total = weight.sum(axis=0)
    return (weight * seen.value).sum(axis=0) / jnp.where(total > 0, total, 1.0), total > 0
