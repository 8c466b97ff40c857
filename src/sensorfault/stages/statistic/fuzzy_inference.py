"""The error of a measurement, predicted by fuzzy rules from its innovation: one test a channel."""

import equinox as eqx
from jaxtyping import Array, Float

from sensorfault.core.types import Residual, Score, Trust
from sensorfault.numerics.fuzzy import Anfis
from sensorfault.stages.statistic.featured import featured


class FuzzyInference(eqx.Module):
    """ANFIS-j of |r|, M² and R* for each measurement j [m]. Xu et al. 2023, section 3; the limit is its T2, (32).

    M² is with the covariance of the residual, R* its noise. `columns[j]`: the channel that model j judges, as long as
    its innovation's variance is no more than `widest[j]` [m²]; the tests of the others are never valid.
    """

    models: tuple[Anfis, ...]
    widest: Float[Array, " L"]
    columns: tuple[int, ...] = eqx.field(static=True)

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        return featured(self.models, self.columns, self.widest, residual), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
