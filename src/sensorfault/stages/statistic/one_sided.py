"""How much too long each channel's measurement is, in its own standard deviations."""

import equinox as eqx
import jax.numpy as jnp

from sensorfault.core.types import Residual, Score, Trust
from sensorfault.stages.statistic.per_channel import each


class OneSided(eqx.Module):
    """r_i / √S_ii, signed: one test a channel, one-sided.

    For pseudoranges in a town: a signal that came by a detour is too long, never too short. Where most signals do,
    the filter's position lies between, and a two-sided test rejects those that came straight.
    """

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        own = jnp.eye(residual.value.size)
        return each(residual.value / jnp.sqrt((own * residual.cov).sum(axis=1)), residual.valid), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
