"""What models make of the features of innovations: what the statistics share that learn from labelled ones."""

from collections.abc import Callable, Sequence

import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.monitor.statistic.each import each
from sensorfault.numerics.innovation import features
from sensorfault.types import Residual, Score

Rating = Callable[[Float[Array, "3"]], Float[Array, ""]]


def featured(models: Sequence[Rating], columns: tuple[int, ...], residual: Residual) -> Score:
    """One test a channel; those without a model are never valid."""
    own = jnp.eye(residual.value.size)
    value = jnp.where(residual.valid, residual.value, 0.0)
    seen = features(value, (own * residual.cov).sum(axis=1), residual.noise)
    rated = dict(zip(columns, models, strict=True))
    told = jnp.stack([rated[c](seen[c]) if c in rated else jnp.zeros(()) for c in range(value.size)])
    return each(told, residual.valid & jnp.asarray([c in rated for c in range(value.size)]))
