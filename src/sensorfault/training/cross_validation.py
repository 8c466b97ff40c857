"""The error of a reconstruction on healthy rows that it was not fitted on."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from collections.abc import Callable

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.calibration.scaling import Scaling
from sensorfault.numerics.networks.activations import ACTIVATIONS
from sensorfault.stages.residual.reconstruction import Reconstruction
from sensorfault.training.blocks import blocks_of

Fit = Callable[[Float[np.ndarray, "N C"], Scaling], Reconstruction]


def residual_of(found: Reconstruction, value: Float[np.ndarray, "N C"]) -> Float[np.ndarray, "N C"]:
    """Residual of a fitted network for each row [SI]."""
    half = np.asarray(found.half)
    x = (value - np.asarray(found.center)) / half
    # (3), (4) x~ = f(x W' + b) beta
    h = np.asarray(ACTIVATIONS[found.activation](x @ np.asarray(found.weights).T + np.asarray(found.bias)))
    left = x - (h @ np.asarray(found.output).T + np.asarray(found.offset))
    return np.where(np.asarray(found.watched), left * half, 0.0)


def largest_unseen_norm(
    value: Float[np.ndarray, "N C"], watched: Bool[np.ndarray, " C"], fit: Fit, scale: Float[np.ndarray, " C"]
) -> float:
    """Largest norm of residual / scale over contiguous blocks, each tested with a fit on all other blocks.

    A network that copies its training data has much larger errors just outside them; its largest training error does
    not show that.
    """
    norms = []
    for block in blocks_of(len(value)):
        rest = np.delete(value, block, axis=0)
        found = fit(rest, Scaling.of(rest, watched))
        norms.append(float(np.linalg.norm(residual_of(found, value[block]) / scale, axis=1).max()))
    return max(norms)
