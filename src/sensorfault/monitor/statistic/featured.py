"""What a model makes of the features of an innovation: what the statistics share that learn from labelled ones."""

from collections.abc import Callable, Sequence

import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.numerics.columns import picked
from sensorfault.numerics.innovation import features
from sensorfault.types import Residual, Score


def featured(
    models: Sequence[Callable[[Float[Array, "3"]], Float[Array, ""]]], columns: tuple[int, ...], residual: Residual
) -> Score:
    """One test a model, which examines and accuses its column alone."""
    valid, value = residual.valid, residual.value
    own = jnp.eye(value.size, dtype=bool)
    variance = (own * residual.cov).sum(axis=1)
    seen = features(jnp.where(valid, value, 0.0), variance, residual.noise)
    told = jnp.stack([model(seen[column]) for model, column in zip(models, columns, strict=True)])
    mine = picked(own, columns)
    return Score(told, picked(valid, columns), mine, mine.astype(value.dtype))
