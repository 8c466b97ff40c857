"""Who lies, of several that should agree: named only if nobody else can explain who disagrees with whom."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.types import Residual, Score, Trust


class Agreement(eqx.Module):
    """|gap| / (limit growth) of each pair, of a jump and of a drift; for residual/height_witnesses.py.

    A sensor is accused if it takes part in every disagreement and no other sensor does. Two of one sensor that disagree
    accuse it, whatever others say; two sensors of which no third knows more stay unaccused: something is wrong, unknown
    which. Of the accused sensor those channels are named that take part in every disagreement, or, if none does, all
    that take part in one.
    """

    limit: Float[Array, "2 P"]
    pairs: tuple[tuple[int, int], ...] = eqx.field(static=True)  # of columns
    owner: tuple[int, ...] = eqx.field(static=True)

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        told = residual.extra
        channels = jnp.arange(len(self.owner))
        covers = jnp.stack([(channels == i) | (channels == j) for i, j in self.pairs])  # pair by channel
        out = covers & jnp.broadcast_to(jnp.asarray(residual.out), channels.shape)[None]
        known = told.known & ~out.any(axis=1)[None]
        value = jnp.abs(told.gap) / (self.limit * told.growth[None])
        over = known & (value > 1)
        named = self._named(over.any(axis=0), covers)
        blame = jnp.tile(covers & named[None], (2, 1))
        return Score(value.ravel(), known.ravel(), jnp.tile(covers, (2, 1)), blame.astype(value.dtype)), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()

    def _named(self, over: Bool[Array, " P"], covers: Bool[Array, "P C"]) -> Bool[Array, " C"]:
        owner = jnp.asarray(self.owner)
        same = owner[:, None] == owner[None]
        touched = (covers[:, :, None] & same[None]).any(axis=1)  # pair by channel: of a sensor that takes part
        explains = over.any() & (~over[:, None] | touched).all(axis=0)  # each channel: its sensor does, everywhere
        alone = explains & ~(explains[None] & ~same).any(axis=1)
        always = alone & (~over[:, None] | covers).all(axis=0)
        once = alone & (over[:, None] & covers).any(axis=0)
        return jnp.where(always.any(), always, once)
