"""Local outlier factor of what the last seconds say of each channel, over several windows at once."""

import equinox as eqx
import jax.numpy as jnp

from sensorfault.core.types import Residual, Score, Trust
from sensorfault.numerics.outlier_factor import LocalDensity
from sensorfault.stages.statistic.means import Means
from sensorfault.stages.statistic.past import Past
from sensorfault.stages.statistic.per_channel import each


class WindowedOutlierFactor(eqx.Module):
    """LOF of each channel's means over several windows, a feature each, against a frozen history of all channels'.

    After Wang et al. 2023, equations (10)-(13), whose feature is the innovation alone.
    """

    history: LocalDensity
    means: Means

    def init(self) -> Past:
        return self.means.init()

    def evaluate(self, state: Past, residual: Residual) -> tuple[Score, Past]:
        mean, after = self.means.over(state, residual)
        asked = jnp.where(residual.valid[:, None], mean, 0.0)
        return each(self.history.outlier_factor(asked), residual.valid), after

    def update(self, pending: Past, trust: Trust) -> Past:
        return pending
