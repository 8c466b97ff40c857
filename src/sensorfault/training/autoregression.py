"""The linear autoregressive predictor, fitted by least squares."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp
import numpy as np

from sensorfault.logs.table import LogError
from sensorfault.numerics.networks.dense import Dense, Linear
from sensorfault.training.windows import Windows


def fit_autoregression(windows: Windows) -> Linear:
    """y~ = W x + b of the whole window x; the least-squares W of smallest norm.

    Raises:
        LogError: no window.
    """
    if not len(windows.first):
        raise LogError(
            f"no {windows.length} rows follow each other without a gap, so nothing can be fitted; give a longer log."
        )
    x = np.concatenate([windows.matrix(), np.ones((len(windows.first), 1))], axis=1)
    # min ||x W' - y||
    found = np.linalg.lstsq(x, windows.target)[0]
    return Linear(Dense(jnp.asarray(found[:-1].T), jnp.asarray(found[-1])))
