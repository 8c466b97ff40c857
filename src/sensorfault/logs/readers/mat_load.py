"""The vectors in a MATLAB file, by SciPy."""

import warnings
from typing import Any

import numpy as np

from sensorfault.logs.readers.subprocess_reader import Loaded

_WIDEST = 16  # columns of a matrix
_NUMBERS = "biuf"  # numpy's letters for truths, whole numbers and floats


def load(path: str) -> Loaded:
    """The numbers of every structure; under "" those that stand in none. Functions and objects are left alone.

    Raises:
        Exception: of any kind, if the file is damaged.
    """
    from scipy.io import loadmat  # lazily: half a second that only this format needs

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = loadmat(path, squeeze_me=True, struct_as_record=False)
    found = {name: one for name, one in found.items() if not name.startswith("__")}
    structures = {name: vars(one) for name, one in found.items() if hasattr(one, "_fieldnames")}
    structures |= labelled(found)
    structures[""] = {name: one for name, one in found.items() if name not in structures}
    return Loaded({name: _vectors(fields) for name, fields in structures.items()})


def labelled(found: dict[str, Any]) -> dict[str, dict[str, Any]]:
    """Tables of Mission Planner: an array `GPS` beside the list `GPS_label` of what its columns are called."""
    tables = {}
    for name, one in found.items():
        labels = [str(label) for label in np.ravel(found.get(f"{name}_label", ()))]
        if labels and getattr(one, "ndim", 0) == 2 and one.shape[1] == len(labels):
            tables[name] = dict(zip(labels, one.T, strict=True))
    return tables


def _vectors(fields: dict[str, Any]) -> dict[str, np.ndarray]:
    """The vectors of numbers; of a matrix its columns."""
    arrays = {name: np.asarray(one) for name, one in fields.items() if not name.startswith("_")}
    numbers = {name: one for name, one in arrays.items() if one.dtype.kind in _NUMBERS}
    return {name: vector for key, one in numbers.items() for name, vector in columns_of(key, one).items()}


def columns_of(name: str, value: np.ndarray) -> dict[str, np.ndarray]:
    """A vector itself; of a matrix of a few columns, or rows, each of them: three are x, y, z."""
    if value.ndim == 1:
        return {name: value}
    if value.ndim != 2 or min(value.shape) > _WIDEST or max(value.shape) <= _WIDEST:
        return {}
    columns = value.T if value.shape[0] > value.shape[1] else value
    names = [f"{name}_{axis}" for axis in "xyz"] if len(columns) == 3 else [f"{name}[{i}]" for i in range(len(columns))]
    return dict(zip(names, columns, strict=True))
