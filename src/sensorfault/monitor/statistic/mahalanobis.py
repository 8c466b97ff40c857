"""Residual against its covariance: one test a sample, blamed on the channel that, if freed, takes most of it away."""

import equinox as eqx
import jax.numpy as jnp

from sensorfault.numerics.gaussian import precision
from sensorfault.types import Residual, Score, Trust


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
        own = jnp.eye(len(valid))
        sigma = jnp.sqrt((own * residual.cov).sum(axis=1))
        e = jnp.where(valid, residual.value / sigma, 0.0)
        largest = jnp.maximum(jnp.abs(e).max(), 1e-300)  # taken out before squaring, lest a wild value overflow
        p = precision(residual.cov / (sigma[:, None] * sigma[None]), valid)
        # P e
        pull = p @ (e / largest)
        # e' P e
        total = jnp.maximum((e / largest * pull).sum(), 0.0)
        # (P e)_k^2 / P_kk
        taken = jnp.where(valid, pull**2 / jnp.where(valid, (own * p).sum(axis=1), 1.0), 0.0)
        square = taken.max() if self.single else total
        score = Score(
            value=largest * jnp.sqrt(square)[None],
            valid=valid.any()[None],
            covers=valid[None],
            blame=jnp.minimum(taken / jnp.where(total > 0, total, 1.0), 1.0)[None],
        )
        return score, ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
