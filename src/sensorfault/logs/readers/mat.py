"""MATLAB `.mat` files: a structure of vectors of one length is a table, and so are the vectors beside it."""

import struct
from collections import Counter
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import polars as pl

from sensorfault.logs.phrase import counted
from sensorfault.logs.readers.extra import missing
from sensorfault.logs.readers.format import Format, remembering
from sensorfault.logs.readers.mat_load import load
from sensorfault.logs.readers.native import native
from sensorfault.logs.readers.source import Ask, Damage, Source, Tables, with_notes
from sensorfault.logs.readers.subprocess_reader import Loaded, load_apart, reason
from sensorfault.logs.table import LogError

_HEAD, _TAG = 128, struct.Struct("<II")
_PACKED = 15  # miCOMPRESSED
_NEWEST = b"MATLAB 7.3"  # how it begins; HDF5 follows
_OWN = "variables"  # the table of vectors that stand in no structure


def read_mat(path: Path, ask: Ask) -> Tables:
    """Every table in the file, by the name of its structure. Functions and objects are left alone.

    Raises:
        LogError: not a whole MATLAB file, no vectors of numbers in it, or of version 7.3 and h5py is not installed.
    """
    loaded = _loaded(path)
    damage = [
        Damage(f"a vector cannot be read ({why})", f"'{name}'", "the others were read")
        for name, why in loaded.result.get("lost", ())
    ]
    tables = {name or _OWN: _table(path, vectors) for name, vectors in loaded.vectors.items()}
    whole = {name: table for name, table in tables.items() if table is not None}
    if not whole:
        lost = f" ({damage[0].what} at {damage[0].where})" if damage else ""
        raise LogError(
            f"{path}: no vectors of numbers of one length{lost}; save a structure of them, with one for the time."
        )
    return with_notes(whole, (), damage)


def _loaded(path: Path) -> Loaded:
    """What is packed (version 7, MATLAB's default) carries checksums: all else is read where damage does no harm."""
    newest = _is_7_3(path)
    if newest and find_spec("h5py") is None:
        raise missing(path, "h5py", "matlab")
    try:
        if newest:
            return load_apart("mat73_load", path)
        return load(str(path)) if _all_packed(path) else load_apart("mat_load", path)
    except Exception as error:  # a damaged file fails in as many ways as it can be damaged
        if isinstance(error, OSError) and error.errno is not None:
            raise  # no fault of the content
        raise LogError(
            f"{path}: not a whole MATLAB file ({reason(error)}); save it again with `save(..., '-v7')`."
        ) from None


def _is_7_3(path: Path) -> bool:
    with path.open("rb") as file:
        return file.read(len(_NEWEST)) == _NEWEST


def _all_packed(path: Path) -> bool:
    """Whether each variable of the file is packed."""
    size = path.stat().st_size
    with path.open("rb") as file:
        if file.read(_HEAD)[126:] != b"IM":
            return False
        at = _HEAD
        while at + _TAG.size <= size:
            file.seek(at)
            kind, length = _TAG.unpack(file.read(_TAG.size))
            if kind != _PACKED:
                return False
            at += _TAG.size + length
    return at == size


def _table(path: Path, vectors: dict[str, np.ndarray]) -> Source | None:
    """The vectors of the usual length as columns."""
    lengths = Counter(len(one) for one in vectors.values() if len(one) > 1)
    if not lengths:
        return None
    rows = lengths.most_common(1)[0][0]
    columns = {name: native(one) for name, one in vectors.items() if len(one) == rows}
    others = [name for name, one in vectors.items() if len(one) not in (rows, 1)]
    said = (
        f"{path.name}: {counted(len(others), 'vector')} of another length than {rows} left out: {', '.join(others)}.",
    )
    return Source(path, pl.DataFrame(columns), notes=said if others else ())


FORMAT = Format("MATLAB", ("*.mat",), remembering(read_mat))
