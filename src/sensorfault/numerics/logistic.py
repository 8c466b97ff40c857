"""Logistic regression of a few features."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from typing import Any

import equinox as eqx
from jaxtyping import Float

from sensorfault.numerics.unit_range import UnitRange


class Logistic(eqx.Module):
    """Log odds, linear in features scaled by their training range. NumPy or JAX, as the features are."""

    unit: UnitRange
    weights: Float[Any, " F"]
    bias: Float[Any, ""]

    def __call__(self, features: Float[Any, "*batch F"]) -> Float[Any, "*batch"]:
        # ln(p / (1 - p)) = w x + b
        return (self.unit(features) * self.weights).sum(axis=-1) + self.bias
