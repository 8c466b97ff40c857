"""Residual against its covariance: one test a sample, blamed on the channel that, if freed, takes most of it away."""

import equinox as eqx
import jax.numpy as jnp

from sensorfault.core.types import Residual, Score, Trust
from sensorfault.numerics.gaussian import baarda_w


class Mahalanobis(eqx.Module):
    """sqrt(e' S^-1 e) over the valid channels, S = `residual.cov`; the others are marginalised out.

    Blame is the share of the squared distance that goes away when channel k may be anything: (P e)_k^2 / P_kk with
    P = S^-1, the likelihood ratio of one offset on k (Wang et al. 2023 call its root w). With `single` the score is the
    root of the largest of these instead of the whole distance: the sharper test where one channel lies at a time.
    """

    single: bool = eqx.field(static=True, default=False)

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        valid = residual.valid
        own = baarda_w(residual.value, residual.cov, valid)
        square = own.taken.max() if self.single else own.total
        score = Score(
            value=own.largest * jnp.sqrt(square)[None],
            valid=valid.any()[None],
            covers=valid[None],
            blame=jnp.minimum(own.taken / jnp.where(own.total > 0, own.total, 1.0), 1.0)[None],
        )
        return score, ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
