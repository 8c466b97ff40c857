"""Linear scaling of the training range to [-1, 1]."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from dataclasses import dataclass

import jax.numpy as jnp
import numpy as np
from jaxtyping import Bool, Float

from sensorfault.stages.residual.reconstruction import Reconstruction


@dataclass(frozen=True)
class Scaling:
    """x = (value - center) / half for watched channels, 0 for the others. Min et al. 2021, after equation (5)."""

    center: Float[np.ndarray, " C"]
    half: Float[np.ndarray, " C"]
    watched: Bool[np.ndarray, " C"]

    @classmethod
    def of(cls, value: Float[np.ndarray, "N C"], watched: Bool[np.ndarray, " C"]) -> "Scaling":
        """From the extremes of healthy rows (SI, finite); a constant channel is not scaled."""
        low, high = value.min(axis=0), value.max(axis=0)
        half = (high - low) / 2
        return cls(np.where(watched, (low + high) / 2, 0.0), np.where(watched & (half > 0), half, 1.0), watched)

    def to_unit(self, value: Float[np.ndarray, "N C"]) -> Float[np.ndarray, "N C"]:
        x: Float[np.ndarray, "N C"] = np.where(self.watched, (value - self.center) / self.half, 0.0)
        return x

    def reconstruction(
        self,
        weights: Float[np.ndarray, "L C"],
        bias: Float[np.ndarray, " L"],
        output: Float[np.ndarray, "C L"],
        offset: Float[np.ndarray, " C"],
        activation: str,
        residual: Float[np.ndarray, "N C"],
    ) -> Reconstruction:
        """The fitted residual generator; `residual`: of the healthy rows, scaled to [-1, 1]."""
        # covariance in SI; an unwatched channel gets unit variance, so that the covariance is not singular
        cov = np.cov(residual.T) * np.outer(self.half, self.half) + np.diag(np.where(self.watched, 0.0, 1.0))
        return Reconstruction(
            weights=jnp.asarray(weights),
            bias=jnp.asarray(bias),
            output=jnp.asarray(output),
            offset=jnp.asarray(offset),
            center=jnp.asarray(self.center),
            half=jnp.asarray(self.half),
            cov=jnp.asarray(cov),
            watched=jnp.asarray(self.watched),
            activation=activation,
        )
