"""Local outlier factor of each innovation against a history of healthy ones, without a presumed distribution."""

import equinox as eqx
import jax.numpy as jnp

from sensorfault.core.types import Residual, Score, Trust
from sensorfault.numerics.outlier_factor import LocalDensity
from sensorfault.stages.statistic.per_channel import each


class OutlierFactor(eqx.Module):
    """LOF of each channel's innovation alone. Wang et al. 2023, equations (10)-(13).

    One history serves all channels, of z_i / √S_ii, or with `raw` of z_i as printed [SI]. It is frozen: no fault can
    creep into it.
    """

    history: LocalDensity
    raw: bool = eqx.field(static=True, default=False)

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        variance = (jnp.eye(residual.value.size) * residual.cov).sum(axis=1)
        value = jnp.where(residual.valid, residual.value, 0.0)
        asked = value if self.raw else value / jnp.sqrt(variance)
        return each(self.history.outlier_factor(asked[:, None]), residual.valid), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
