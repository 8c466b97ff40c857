"""MATLAB `.mat` files: a structure of vectors of one length is a table, and so are the vectors beside it."""

from collections import Counter
from pathlib import Path

import numpy as np
import polars as pl

from sensorfault.logs.phrase import counted
from sensorfault.logs.readers.mat_apart import load
from sensorfault.logs.readers.mat_load import Vectors, reason
from sensorfault.logs.readers.native import native
from sensorfault.logs.readers.source import Ask, Source, Tables
from sensorfault.logs.table import LogError

_OWN = "variables"  # the table of vectors that stand in no structure


def read_mat(path: Path, ask: Ask) -> Tables:
    """Every table in the file, by the name of its structure. Functions and objects are left alone.

    Raises:
        LogError: not a whole MATLAB file, one of version 7.3 (HDF5), or no vectors of numbers in it.
    """
    tables = {name or _OWN: _table(path, vectors) for name, vectors in _structures(path).items()}
    whole = {name: table for name, table in tables.items() if table is not None}
    if not whole:
        raise LogError(f"{path}: no vectors of numbers of one length; save a structure of them, with one for the time.")
    return whole


def _structures(path: Path) -> Vectors:
    try:
        return load(path)
    except NotImplementedError:
        raise LogError(f"{path}: this is MATLAB's version 7.3; save it again with `save(..., '-v7')`.") from None
    except Exception as error:  # a damaged file fails in as many ways as it can be damaged
        if isinstance(error, OSError) and error.errno is not None:
            raise  # no fault of the content
        raise LogError(
            f"{path}: not a whole MATLAB file ({reason(error)}); save it again with `save(..., '-v7')`."
        ) from None


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
