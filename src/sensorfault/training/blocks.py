"""The blocks of a log that a cross-validation leaves out one after the other."""

import numpy as np
from jaxtyping import Int

BLOCKS = 5


def blocks_of(rows: int) -> list[Int[np.ndarray, " n"]]:
    """The rows of each block: contiguous, as neighbours are alike."""
    return np.array_split(np.arange(rows), BLOCKS)
