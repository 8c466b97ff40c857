"""NumPy arrays: times in one file, values in another."""

from pathlib import Path

import numpy as np

from fuzz.writing import COLUMNS, TIME


def npy(folder: Path) -> Path:
    np.save(folder / "accelerometer__t.npy", TIME)
    path = folder / "accelerometer__value.npy"
    np.save(path, np.column_stack([COLUMNS[name] for name in ("ax", "ay", "az")]))
    return path


SMALL = {"NumPy arrays": npy}
