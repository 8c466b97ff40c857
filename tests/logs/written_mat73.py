"""MATLAB files of version 7.3 as MATLAB writes them: HDF5 behind a head of 512 bytes, arrays lying the other way."""

from pathlib import Path
from typing import Any

import h5py
import numpy as np

_HEAD = b"MATLAB 7.3 MAT-file, Platform: GLNXA64, Created on: Sun Aug 24 12:00:00 2025 HDF5 schema 1.00 ."
_CLASSES = {"f8": "double", "f4": "single", "b1": "logical"}


def save(path: Path, content: dict[str, Any], packed: bool = True) -> Path:
    """Arrays of two axes, text, and structures of both; `packed`: as MATLAB does unless it is told otherwise."""
    with h5py.File(path, "w", userblock_size=512) as file:
        for name, one in content.items():
            _put(file, name, one, packed)
        file.create_group("#refs#")
    head = _HEAD.ljust(116) + bytes(8) + b"\x00\x02IM"
    with path.open("r+b") as plain:
        plain.write(head)
    return path


def _put(into: Any, name: str, one: Any, packed: bool) -> None:
    if isinstance(one, dict):
        group = into.create_group(name)
        group.attrs["MATLAB_class"] = np.bytes_("struct")
        for field, inner in one.items():
            _put(group, field, inner, packed)
        return
    if isinstance(one, str):
        array, kind = np.array([[ord(letter)] for letter in one], np.uint16), "char"
    else:
        array = np.atleast_2d(one).T  # a column of MATLAB's is a row here
        kind = _CLASSES.get(array.dtype.str[1:], array.dtype.name)
    if not array.size:
        dataset = into.create_dataset(name, data=np.array([0, 0], np.uint64))
        dataset.attrs["MATLAB_empty"] = np.uint8(1)
    else:
        array = array.astype(np.uint8) if kind == "logical" else array
        chunks = {"compression": "gzip", "chunks": array.shape} if packed and array.size > 1 else {}
        dataset = into.create_dataset(name, data=array, **chunks)
    dataset.attrs["MATLAB_class"] = np.bytes_(kind)
