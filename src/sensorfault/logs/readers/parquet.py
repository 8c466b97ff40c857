"""Parquet tables."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import polars as pl

from sensorfault.logs.readers.format import Format, in_parts
from sensorfault.logs.readers.quiet import quiet
from sensorfault.logs.readers.source import PART, Ask, Source
from sensorfault.logs.table import LogError


def read_parquet(path: Path) -> Source:
    """One Parquet table; columns of lists and structures are left out.

    Raises:
        LogError: not a Parquet file, or nothing in it.
    """
    with _readable(path):
        return _source(path, pl.read_parquet(path, glob=False))


def rest_of_parquet(path: Path, ask: Ask) -> Source:
    """The last rows of a table, once all before them have been handed on to `ask.part`.

    Raises:
        LogError: as `read_parquet`.
    """
    assert ask.part is not None
    with _readable(path):
        lazy = pl.scan_parquet(path, glob=False)
        schema, rows = lazy.collect_schema(), int(lazy.select(pl.len()).collect().item())
    step = max(2, PART // max(1, len(schema)))
    starts = range(0, max(rows, 1), step)
    for start in starts:
        with _readable(path):
            source = _source(path, lazy.slice(start, step).collect())
        if start != starts[-1]:
            ask.part({"": source})
        ask.tell(min(1.0, (start + step) / rows))
    return source


@contextmanager
def _readable(path: Path) -> Iterator[None]:
    try:
        with quiet():
            yield
    except (pl.exceptions.PolarsError, pl.exceptions.PanicException, OSError) as error:
        reason = str(error).splitlines()[0]
        raise LogError(f"{path}: this is not a readable Parquet file ({reason}); export the log again.") from None


def _source(path: Path, frame: pl.DataFrame) -> Source:
    flat = [name for name, dtype in frame.schema.items() if not dtype.is_nested()]
    if not flat or not len(frame):
        raise LogError(f"{path}: the table is empty; name a log with rows.")
    notes = []
    if len(flat) < frame.width:
        notes.append(f"{path.name}: {frame.width - len(flat)} columns hold lists or structures and were left out.")
    return Source(path, frame.select(flat), notes=tuple(notes))


FORMAT = Format("Parquet", ("*.parquet",), in_parts(read_parquet, rest_of_parquet), parts=True)
