"""Numbers of any type and byte order as the columns that a table has."""

import numpy as np


def native(vector: np.ndarray) -> np.ndarray:
    """Contiguous float64, or int64 where a float might round."""
    wide = np.int64 if vector.dtype.kind in "iu" and vector.dtype.itemsize == 8 else np.float64
    return np.ascontiguousarray(vector, dtype=wide)
