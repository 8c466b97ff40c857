"""The linear predictor: least squares, at once."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp
import numpy as np

from sensorfault.logs.table import LogError
from sensorfault.numerics.networks.dense import Dense, Linear
from sensorfault.training.windows import Windows


def fit_autoregression(windows: Windows) -> Linear:
    """y~ = W x + b of the whole window x, the shortest W of all that leave the least square error.

    Raises:
        LogError: no window.
    """
    if not len(windows.first):
        raise LogError(f"there is no unbroken window of {windows.length} rows to learn from; give a longer log.")
    x = np.concatenate([windows.matrix(), np.ones((len(windows.first), 1))], axis=1)
    # min ||x W' - y||
    found = np.linalg.lstsq(x, windows.target)[0]
    return Linear(Dense(jnp.asarray(found[:-1].T), jnp.asarray(found[-1])))
