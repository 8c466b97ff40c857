"""The adaptive limit of the multi-step observer, from a companion filter and recent residuals."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import Residual, Score, Trust


class _Past(NamedTuple):
    squares: Float[Array, "n K"]  # of the last residuals that were believed, the newest last [SI^2]


class _Work(NamedTuple):
    past: _Past
    square: Float[Array, " K"]
    valid: Bool[Array, " K"]


class Adaptive(eqx.Module):
    """T = a T_EKF + b E, Wang et al., the adaptive threshold after the chi-square test of the EKF's innovation.

    T_EKF(k) = √(χ² S(k)) with `chi_square` the quantile for one degree of freedom, and S the variance of the innovation
    of part `part` of residual/several.py. E is the root mean square of the residuals of `window` believed measurements
    that end `lag` before this one: with the present residual in it, as printed, a b of 1 could never alarm. What is not
    believed is left out, so E is frozen during an alarm. Before anything is known, E is `typical`.
    """

    a: Float[Array, " K"]
    b: Float[Array, " K"]
    typical: Float[Array, " K"]  # root mean square of healthy residuals [SI]
    chi_square: Float[Array, ""]
    part: int = eqx.field(static=True)
    column: int = eqx.field(static=True)
    window: int = eqx.field(static=True, default=25)
    lag: int = eqx.field(static=True, default=5)

    def init(self) -> _Past:
        return _Past(jnp.tile(self.typical**2, (self.window + self.lag - 1, 1)))

    def evaluate(self, state: _Past, seen: tuple[Residual, Score]) -> tuple[Float[Array, " K"], _Work]:
        residual, score = seen
        s = residual.extra[self.part].cov[self.column, self.column]
        # T_EKF = √(χ² S)
        by_filter = jnp.sqrt(self.chi_square * s)
        error = jnp.sqrt(state.squares[: self.window].mean(axis=0))
        # T = a T_EKF + b E
        return self.a * by_filter + self.b * error, _Work(state, score.value**2, score.valid)

    def update(self, pending: _Work, trust: Trust) -> _Past:
        past, square, valid = pending
        newest = jnp.where(valid, square, past.squares[-1])
        shifted = jnp.concatenate([past.squares[1:], newest[None]])
        return _Past(jnp.where(valid.any() & trust.learn[self.column], shifted, past.squares))
