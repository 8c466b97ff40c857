"""Limits of a χ² test for a false alarm rate, for any number of channels."""

import jax.numpy as jnp
import numpy as np

from sensorfault.stages.threshold.chi_square import ChiSquare


def chi_square(false_alarms: float, channels: int) -> ChiSquare:
    """√χ²(m), m up to `channels`, that a share `false_alarms` of the epochs exceeds if innovations are Gaussian."""
    from scipy.special import chdtri

    return ChiSquare(jnp.asarray(np.sqrt(chdtri(np.arange(1.0, channels + 1), false_alarms))))
