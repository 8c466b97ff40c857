"""Models of the features of innovations: shared by the statistics that learn from labelled data."""

from collections.abc import Callable, Sequence

import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.core.types import Residual, Score
from sensorfault.numerics.innovation import features
from sensorfault.stages.statistic.per_channel import each

Rating = Callable[[Float[Array, "3"]], Float[Array, ""]]


def featured(
    models: Sequence[Rating], columns: tuple[int, ...], widest: Float[Array, " L"], residual: Residual
) -> Score:
    """One test a channel; those without a model are never valid.

    Nor is one whose innovation has a larger variance than `widest`: the models saw no such filter in training, and a
    lost filter would take its own error for the measurement's, for ever.
    """
    own = jnp.eye(residual.value.size)
    value = jnp.where(residual.valid, residual.value, 0.0)
    variance = (own * residual.cov).sum(axis=1)
    seen = features(value, variance, residual.noise)
    result, valid = jnp.zeros_like(value), jnp.zeros_like(residual.valid)
    for model, column, most in zip(models, columns, widest, strict=True):
        mine = own[column] > 0
        result = jnp.where(mine, model(seen[column]), result)
        valid = valid | (mine & (variance[column] <= most))
    return each(result, residual.valid & valid)
