"""The size of each channel's residual: one test a channel, which accuses that channel alone."""

import equinox as eqx
import jax.numpy as jnp

from sensorfault.core.types import Residual, Score, Trust
from sensorfault.stages.statistic.per_channel import each


class Absolute(eqx.Module):
    """|y_i - y~_i| [SI]. Niu & Zhao 1998, before equation (4)."""

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        return each(jnp.abs(residual.value), residual.valid), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
