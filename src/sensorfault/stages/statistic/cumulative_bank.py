"""A bank of cumulative innovations: what is slow shows in a long window, what is sudden in a short one."""

import equinox as eqx
import jax.numpy as jnp

from sensorfault.core.types import Residual, Score, Trust
from sensorfault.stages.statistic.means import Means
from sensorfault.stages.statistic.past import Past
from sensorfault.stages.statistic.per_channel import each


class CumulativeBank(eqx.Module):
    """max over windows of |mean normalised innovation| / its healthy spread: one test a channel.

    The spreads are those of healthy data, so correlated noise raises them; the averaged innovation presumes white
    noise.
    """

    means: Means

    def init(self) -> Past:
        return self.means.init()

    def evaluate(self, state: Past, residual: Residual) -> tuple[Score, Past]:
        mean, after = self.means.over(state, residual)
        return each(jnp.abs(mean).max(axis=1), residual.valid), after

    def update(self, pending: Past, trust: Trust) -> Past:
        return pending
