"""The size of each channel's residual in its own standard deviations."""

import equinox as eqx
import jax.numpy as jnp

from sensorfault.core.types import Residual, Score, Trust
from sensorfault.stages.statistic.per_channel import each


class Normalised(eqx.Module):
    """M_i = |r_i| / √S_ii: one test a channel; its square is χ² with one degree of freedom. Xu et al. 2023, (29)."""

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        own = jnp.eye(residual.value.size)
        return each(jnp.abs(residual.value) / jnp.sqrt((own * residual.cov).sum(axis=1)), residual.valid), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
