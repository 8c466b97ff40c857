"""Averaged innovation (AIME) of all satellites at once: one test a sample."""

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.core.types import Residual, Score, Trust
from sensorfault.numerics.gaussian import precision
from sensorfault.stages.statistic.information import Information


class AveragedTogether(eqx.Module):
    """√s², s² = z̄'V⁻¹z̄ with V⁻¹ = ΣS⁻¹ and z̄ = VΣS⁻¹z over the last `window_s`. Diesel & Luu 1995.

    s² is χ² of as many degrees of freedom as channels are covered, if innovations are white and Gaussian, from the
    first sample of a window on and whatever epochs a satellite missed. It tests those that are valid now. Blame is the
    share of s² that goes away when one of them may have a mean.
    """

    window_s: Float[Array, ""]
    channels: int = eqx.field(static=True)
    slots: int = eqx.field(static=True)

    def init(self) -> Information:
        return Information.empty(self.slots, self.channels)

    def evaluate(self, state: Information, residual: Residual) -> tuple[Score, Information]:
        (matrix, vector), after = state.taken(residual, self.window_s)
        own = jnp.eye(self.channels)
        information = (own * matrix).sum(axis=1)
        # s² = (ΣS⁻¹z)' V (ΣS⁻¹z)
        v = precision(matrix, residual.valid)
        total = jnp.maximum((vector[:, None] * v * vector[None]).sum(), 0.0)
        # of one mean alone: (V⁻¹z̄)_i² / (V⁻¹)_ii
        taken = vector**2 / jnp.where(information > 0, information, jnp.inf)
        score = Score(
            value=jnp.sqrt(total)[None],
            valid=residual.valid.any()[None],
            covers=residual.valid[None],
            blame=jnp.minimum(taken / jnp.where(total > 0, total, 1.0), 1.0)[None],
        )
        return score, after

    def update(self, pending: Information, trust: Trust) -> Information:
        return pending
