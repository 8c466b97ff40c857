"""A statistic of one among several residuals."""

from typing import Any

import equinox as eqx
import jax.numpy as jnp

from sensorfault.core.stage import Stage
from sensorfault.core.types import Residual, Score, Trust


class SelectResidual(eqx.Module):
    """`statistic` applied to the residual of part `part` of residual/several.py."""

    statistic: Stage[Any, Residual, Score, Any]
    part: int = eqx.field(static=True)

    def init(self) -> Any:
        return self.statistic.init()

    def evaluate(self, state: Any, residual: Residual) -> tuple[Score, Any]:
        own: Residual = residual.extra[self.part]
        out = jnp.asarray(residual.out)
        return self.statistic.evaluate(state, own._replace(valid=own.valid & ~out, out=residual.out))

    def update(self, pending: Any, trust: Trust) -> Any:
        return self.statistic.update(pending, trust)
