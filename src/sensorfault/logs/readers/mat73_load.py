"""The vectors in a MATLAB file of version 7.3, which is HDF5, by h5py."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from sensorfault.logs.readers.mat_load import columns_of
from sensorfault.logs.readers.subprocess_reader import Loaded, reason

_NUMBERS = ("double", "single", "logical", *(f"{sign}int{bits}" for sign in ("", "u") for bits in (8, 16, 32, 64)))


def load(path: str) -> Loaded:
    """As `mat_load.load`, for version 7.3. In the second result, "lost": why vectors cannot be read.

    Raises:
        Exception: of any kind, if the file is damaged.
    """
    import h5py  # lazily: only this format needs it

    lost: list[list[str]] = []
    structures: dict[str, dict[str, np.ndarray]] = {"": {}}
    with h5py.File(path, "r") as file:
        for name, one in _members(file, "", lost):
            if isinstance(one, h5py.Dataset):
                structures[""] |= _vector(name, one, name, lost)
            elif _class(one) == "struct":
                structures[name] = {}
                for field, inner in _members(one, f"{name}.", lost):
                    if isinstance(inner, h5py.Dataset):
                        structures[name] |= _vector(field, inner, f"{name}.{field}", lost)
    return Loaded(structures, {"lost": lost})


def _members(group: Any, path: str, lost: list[list[str]]) -> Iterator[tuple[str, Any]]:
    """The variables by name, without MATLAB's internal ones (# in the name) and links to other files."""
    import h5py

    for name in group:
        try:
            if not name.startswith("#") and isinstance(group.get(name, getlink=True), h5py.HardLink):
                yield name, group[name]
        except Exception as error:
            lost.append([f"{path}{name}", reason(error)])


def _vector(name: str, dataset: Any, path: str, lost: list[list[str]]) -> dict[str, np.ndarray]:
    """The dataset by its name, if it is a vector of numbers; of a matrix its columns."""
    try:
        kind = _class(dataset)
        if kind not in _NUMBERS or "MATLAB_empty" in dataset.attrs or dataset.external or dataset.is_virtual:
            return {}
        value = np.squeeze(dataset[()])
    except Exception as error:
        lost.append([path, reason(error)])
        return {}
    return columns_of(name, value) if value.dtype.kind in "biuf" else {}


def _class(one: Any) -> str:
    """What MATLAB calls its type."""
    return bytes(one.attrs.get("MATLAB_class", b"")).decode()
