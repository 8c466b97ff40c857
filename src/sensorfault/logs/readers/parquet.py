"""Parquet tables."""

from pathlib import Path

import polars as pl

from sensorfault.logs.readers.quiet import quiet
from sensorfault.logs.readers.source import Source
from sensorfault.logs.table import LogError


def read_parquet(path: Path) -> Source:
    """One Parquet table; columns of lists and structures are left out.

    Raises:
        LogError: not a Parquet file, or nothing in it.
    """
    try:
        with quiet():
            frame = pl.read_parquet(path, glob=False)
    except (pl.exceptions.PolarsError, pl.exceptions.PanicException, OSError) as error:
        reason = str(error).splitlines()[0]
        raise LogError(f"{path}: this is not a readable Parquet file ({reason}); export the log again.") from None
    flat = [name for name, dtype in frame.schema.items() if not dtype.is_nested()]
    if not flat or not len(frame):
        raise LogError(f"{path}: the table is empty; name a log with rows.")
    notes = []
    if len(flat) < frame.width:
        notes.append(f"{path.name}: {frame.width - len(flat)} columns hold lists or structures and were left out.")
    return Source(path, frame.select(flat), notes=tuple(notes))
