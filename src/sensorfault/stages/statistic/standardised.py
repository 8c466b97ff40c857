"""A χ² test's score as a standard normal number, so that one limit serves whatever the number of channels."""

from typing import Any

import equinox as eqx
import jax.numpy as jnp

from sensorfault.core.stage import Stage
from sensorfault.core.types import Residual, Score, Trust


class Standardised(eqx.Module):
    """(∛(q/m) - (1 - 2/(9m))) / √(2/(9m)) of a score √q that covers m channels. Wilson & Hilferty 1931.

    A limit from healthy data of nine satellites then holds for six. It is approximate: far out it says a little less
    than the tail of χ² (3.65 for 3.71 at m = 5, 4.06 for 4.26 at m = 1). threshold/chi_square.py has the exact limits.
    """

    statistic: Stage[Any, Residual, Score, Any]

    def init(self) -> Any:
        return self.statistic.init()

    def evaluate(self, state: Any, residual: Residual) -> tuple[Score, Any]:
        score, pending = self.statistic.evaluate(state, residual)
        m = jnp.maximum(score.covers.sum(axis=1).astype(score.value.dtype), 1.0)
        spread = 2 / (9 * m)
        value = ((score.value**2 / m) ** (1 / 3) - (1 - spread)) / jnp.sqrt(spread)
        return score._replace(value=value), pending

    def update(self, pending: Any, trust: Trust) -> Any:
        return self.statistic.update(pending, trust)
