"""Features scaled by their training range."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from typing import Any

import equinox as eqx
from jaxtyping import Float

LEAST = 1e-300  # smallest number for the logarithm


class UnitRange(eqx.Module):
    """x = (f - low) / span, f the feature or with `log` its logarithm: 0 to 1 in training.

    Features are sizes, the smaller the healthier: below the smallest of training is as it. Beyond the largest, x goes
    on to 1 + `reach` and no further, since nothing was learned there. NumPy or JAX, as the features are.
    """

    low: Float[Any, " F"]
    span: Float[Any, " F"]
    reach: Float[Any, ""]
    log: bool = eqx.field(static=True, default=False)

    def __call__(self, features: Float[Any, "*batch F"]) -> Float[Any, "*batch F"]:
        xp = features.__array_namespace__()
        size = xp.log(xp.maximum(features, LEAST)) if self.log else features
        return xp.clip((size - self.low) / self.span, 0.0, 1.0 + self.reach)
