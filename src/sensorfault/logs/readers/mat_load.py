"""The vectors in a MATLAB file, by SciPy."""

import warnings
from typing import Any

import numpy as np

from sensorfault.logs.readers.subprocess_reader import Loaded

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
    structures[""] = {name: one for name, one in found.items() if name not in structures}
    return Loaded({name: _vectors(fields) for name, fields in structures.items()})


def _vectors(fields: dict[str, Any]) -> dict[str, np.ndarray]:
    arrays = {name: np.asarray(one) for name, one in fields.items() if not name.startswith("_")}
    return {name: one for name, one in arrays.items() if one.ndim == 1 and one.dtype.kind in _NUMBERS}
