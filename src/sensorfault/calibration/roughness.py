"""How rough a healthy drive was: the range of a score's running RMS."""

import numpy as np
from jaxtyping import Float


def roughness(
    scores: Float[np.ndarray, "T K"], memory: float
) -> tuple[Float[np.ndarray, " K"], Float[np.ndarray, " K"]]:
    """Median and maximum over a drive of the RMS over `memory` samples; ones for a test without scores."""
    middle, most = np.ones(scores.shape[1]), np.ones(scores.shape[1])
    for k, score in enumerate(scores.T):
        square = score[np.isfinite(score)] ** 2
        width = min(max(round(memory), 1), square.size)
        if not width:
            continue
        running = np.sqrt(np.convolve(square, np.full(width, 1 / width), mode="valid"))
        middle[k], most[k] = np.median(running), running.max()
    return np.maximum(middle, 1e-12), np.maximum(most, 1e-12)
