"""The size of every residual of a bank that watches one channel: one test a member."""

import equinox as eqx
import jax.numpy as jnp

from sensorfault.core.types import Residual, Score, Trust


class Horizons(eqx.Module):
    """|r_N|, for each N of residual/multistep_observer.py [SI]; each accuses `column`."""

    column: int = eqx.field(static=True)

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        bank = residual.extra
        valid = bank.valid & residual.valid[self.column]
        mine = jnp.arange(residual.value.size) == self.column
        blame = jnp.tile(mine.astype(residual.value.dtype), (valid.size, 1))
        return Score(jnp.abs(bank.value), valid, valid[:, None] & mine[None], blame), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
