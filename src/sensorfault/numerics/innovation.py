"""Features of an innovation."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from typing import Any

from jaxtyping import Float

FEATURES = ("innovation", "squared Mahalanobis distance", "adapted noise")
UNITS = ("m", "", "m²")


def features(value: Float[Any, "*s"], variance: Float[Any, "*s"], noise: Float[Any, "*s"]) -> Float[Any, "*s 3"]:
    """|r|, M² and R*, for training and live use. Xu et al. 2023, equations (28)-(31). NumPy or JAX.

    `value`: the innovation; `variance`: as predicted by the filter with the nominal noise; `noise`: the variance of
    the measurement in use, adapted or not.
    """
    xp = value.__array_namespace__()
    # (29) M² = r' Pzz⁻¹ r
    return xp.stack([xp.abs(value), value * value / variance, noise], axis=-1)
