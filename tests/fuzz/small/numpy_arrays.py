"""NumPy arrays: times in one file, values in another."""

from pathlib import Path

import numpy as np

from fuzz.writing import COLUMNS, TIME


def npy(folder: Path) -> Path:
    np.save(folder / "accelerometer__t.npy", TIME)
    path = folder / "accelerometer__value.npy"
    np.save(path, np.column_stack([COLUMNS[name] for name in ("ax", "ay", "az")]))
    return path


def value(folder: Path) -> Path:
    for name, array in (("t", TIME), ("value", np.column_stack([COLUMNS[name] for name in ("ax", "ay", "az")]))):
        (folder / "accelerometer").mkdir(exist_ok=True)
        with (folder / "accelerometer" / name).open("wb") as file:
            np.save(file, array)
    return folder / "accelerometer" / "value"


SMALL = {"NumPy arrays": npy, "comma2k19": value}
