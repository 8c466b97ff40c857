"""Numbers of any type and byte order as the columns that a table has."""

from collections.abc import Mapping

import numpy as np

_ROWS = 4096  # records of so many rows stay in a processor's cache


def native(vector: np.ndarray) -> np.ndarray:
    """Contiguous float64, or int64 where a float might round."""
    return np.ascontiguousarray(vector, dtype=_wide(vector))


def native_fields(fields: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The same of all fields of an array of records, equally long: each record is fetched from memory once."""
    columns: dict[str, np.ndarray] = {name: np.empty(len(field), _wide(field)) for name, field in fields.items()}
    pairs = [(columns[name], field) for name, field in fields.items()]
    for start in range(0, max(map(len, fields.values()), default=0), _ROWS):
        rows = slice(start, start + _ROWS)
        for column, field in pairs:
            column[rows] = field[rows]
    return columns


def _wide(vector: np.ndarray) -> type:
    return np.int64 if vector.dtype.kind in "iu" and vector.dtype.itemsize == 8 else np.float64
