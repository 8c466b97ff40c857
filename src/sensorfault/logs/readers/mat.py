"""MATLAB `.mat` files: a structure of vectors of one length is a table, and so are the vectors beside it."""

from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from sensorfault.logs.phrase import counted
from sensorfault.logs.readers.native import native
from sensorfault.logs.readers.source import Ask, Source, Tables
from sensorfault.logs.table import LogError

_OWN = "variables"  # the table of vectors that stand in no structure
_NUMBERS = "biuf"  # numpy's letters for truths, whole numbers and floats


def read_mat(path: Path, ask: Ask) -> Tables:
    """Every table in the file, by the name of its structure. Functions and objects are left alone.

    Raises:
        LogError: not a whole MATLAB file, one of version 7.3 (HDF5), or no vectors of numbers in it.
    """
    found = _variables(path)
    structures = {name: vars(one) for name, one in found.items() if hasattr(one, "_fieldnames")}
    structures[_OWN] = {name: one for name, one in found.items() if name not in structures}
    tables = {name: _table(path, fields) for name, fields in structures.items()}
    whole = {name: table for name, table in tables.items() if table is not None}
    if not whole:
        raise LogError(f"{path}: no vectors of numbers of one length; save a structure of them, with one for the time.")
    return whole


def _variables(path: Path) -> dict[str, Any]:
    from scipy.io import loadmat  # lazily: half a second that only this format needs

    try:
        found = loadmat(path, squeeze_me=True, struct_as_record=False)
    except NotImplementedError:
        raise LogError(f"{path}: this is MATLAB's version 7.3; save it again with `save(..., '-v7')`.") from None
    except Exception as error:  # a damaged file fails in as many ways as it can be damaged
        if isinstance(error, OSError) and error.errno is not None:
            raise  # no fault of the content
        reason = (str(error).splitlines() or [type(error).__name__])[0].rstrip(".")
        raise LogError(f"{path}: not a whole MATLAB file ({reason}); save it again with `save(..., '-v7')`.") from None
    return {name: one for name, one in found.items() if not name.startswith("__")}


def _table(path: Path, fields: dict[str, Any]) -> Source | None:
    """The vectors of the usual length as columns."""
    vectors = {name: np.asarray(one) for name, one in fields.items() if not name.startswith("_")}
    vectors = {name: one for name, one in vectors.items() if one.ndim == 1 and one.dtype.kind in _NUMBERS}
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
