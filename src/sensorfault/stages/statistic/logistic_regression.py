"""The odds that a measurement is off, from what its innovation looks like: one test a channel."""

import equinox as eqx
from jaxtyping import Array, Float

from sensorfault.core.types import Residual, Score, Trust
from sensorfault.numerics.logistic import Logistic
from sensorfault.stages.statistic.featured import featured


class LogisticRegression(eqx.Module):
    """Log odds of |r|, M² and R* for each measurement: FuzzyInference made linear. Above 0: more likely wrong.

    `columns[j]`: the channel that model j judges, as long as its innovation's variance is no more than `widest[j]`
    [m²]; the tests of the others are never valid.
    """

    models: tuple[Logistic, ...]
    widest: Float[Array, " L"]
    columns: tuple[int, ...] = eqx.field(static=True)

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        return featured(self.models, self.columns, self.widest, residual), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
