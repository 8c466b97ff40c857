"""Records of several kinds in one table: each kind becomes a table of its own."""

import re
from collections import Counter, defaultdict
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl

from sensorfault.logs.phrase import counted
from sensorfault.logs.readers.cells import MISSING, is_valued, numbers_of
from sensorfault.logs.readers.dialect import Dialect, unique
from sensorfault.logs.readers.records import Record, some_records
from sensorfault.logs.readers.source import Source, Tables
from sensorfault.logs.readers.text import plain_bytes
from sensorfault.logs.table import LogError

_NAMES = re.compile(
    r"(sensor|device|record|message|msg|data|measurement)?_?(type|kind|name|id|source|sensor|topic|stream|device|message|msg)",
    re.IGNORECASE,
)
_MOST, _FEWEST = 32, 3  # kinds; rows of one
_OFTEN = 0.1  # share of the rows at which the kind changes: a mode or a gear changes seldom
_VALUE = re.compile(r"val(ue)?|reading|data|measurement", re.IGNORECASE)
_LONG = 2  # columns beside the kind
_WHERE = 3  # first columns that may name the kind where there is no header
_LEFT_OUT = 0.2  # share of the records that may be unlike the others of their kind


def kind_column(frame: pl.DataFrame, headless: bool) -> str | None:
    """The column that names the kind of each row, if there is one."""
    for i, name in enumerate(frame.columns):
        column = frame[name]
        if column.dtype != pl.String or column.null_count() or not (i < _WHERE if headless else _NAMES.fullmatch(name)):
            continue
        counts = Counter(column.to_list())
        words = not any(is_valued(str(kind)) for kind in counts)
        changes = int((column != column.shift(1)).sum())
        many = 2 <= len(counts) <= _MOST and min(counts.values()) >= _FEWEST
        if words and many and changes >= _OFTEN * len(column):
            return name
    return None


def of_kinds(source: Source, kind: str | None) -> Tables:
    """One table for each kind of rows, without the columns that are empty there."""
    if kind is None or kind not in source.frame.columns:
        return {"": source}
    tables: Tables = {}
    for value in source.frame[kind].unique(maintain_order=True):
        rows = np.flatnonzero((source.frame[kind] == value).to_numpy())
        frame = source.frame[rows].drop(kind)
        frame = frame.drop([name for name in frame.columns if frame[name].null_count() == len(frame)])
        if frame.width == _LONG:  # a time and a value: the kind says what of
            frame = frame.rename({name: str(value) for name in frame.columns if _VALUE.fullmatch(name)})
        tables[str(value)] = replace(source, frame=frame, lines=_picked(source, rows), table=str(value))
    return tables


def _picked(source: Source, rows: np.ndarray) -> Callable[[int], int]:
    line = source.lines or (lambda row: row + source.first_line)
    return lambda row: line(int(rows[row]))


def records_of_kinds(path: Path, dialect: Dialect) -> Tables:
    """One table for each kind of record, which the first cell names; cells of one word are names of what follows.

    Raises:
        LogError: too many records are unlike the others of their kind.
    """
    headers: dict[str, Record] = {}
    found: dict[str, list[Record]] = defaultdict(list)
    for record in some_records(_lines(path, dialect), dialect.delimiter):
        kind = record.cells[0] if record.cells else ""
        bare = kind.lstrip("#%/ ")
        if bare and not any(is_valued(cell) for cell in record.cells if cell not in MISSING):
            headers.setdefault(bare, record)
        elif bare == kind and kind:
            found[kind].append(record)
    usual = {kind: Counter(len(one.cells) for one in rows).most_common(1)[0][0] for kind, rows in found.items()}
    good = {kind: [one for one in rows if len(one.cells) == usual[kind]] for kind, rows in found.items()}
    whole = {kind: rows for kind, rows in good.items() if len(rows) >= _FEWEST and usual[kind] > 1}
    names = {kind: one.cells[1:] for kind, one in headers.items() if len(one.cells) == usual.get(kind)}
    lost = sum(map(len, found.values())) - sum(map(len, whole.values())) + len((headers.keys() & usual) - names.keys())
    if not whole or lost > _LEFT_OUT * sum(map(len, found.values())):
        raise LogError(f"{path}: its lines have different numbers of cells, and no first cell that says why; split it.")
    notes = (f"{path.name}: {counted(lost, 'record')} unlike the others of their kind left out.",) if lost else ()
    return {kind: _table(path, kind, rows, names.get(kind, ()), dialect, notes) for kind, rows in whole.items()}


def _lines(path: Path, dialect: Dialect) -> list[tuple[int, str]]:
    text = plain_bytes(path, dialect.text).decode("utf-8-sig", "replace").split("\n")
    return [(i, line.removesuffix("\r")) for i, line in enumerate(text, 1) if line.strip()]


def _table(
    path: Path, kind: str, rows: list[Record], names: Sequence[str], dialect: Dialect, notes: tuple[str, ...]
) -> Source:
    width = len(rows[0].cells) - 1
    columns = [pl.Series([row.cells[i + 1] for row in rows]) for i in range(width)]
    named = names if len(names) == width else _labelled(columns)
    values = {
        name: numbers_of(column, dialect.decimal_comma) for name, column in zip(unique(named), columns, strict=True)
    }
    frame = pl.DataFrame({name: column for name, column in values.items() if not _is_label(column)})
    return Source(path, frame, notes=notes, table=kind, first_line=rows[0].line, lines=lambda row: rows[row].line)


def _labelled(columns: Sequence[pl.Series]) -> list[str]:
    """The names of columns behind a cell that is always the same word: AngularVelocity.x, .y, .z."""
    names: list[str] = []
    label, since = "", 0
    after = {i: _length(columns, i + 1) for i in range(len(columns))}
    for i, column in enumerate(columns):
        if _is_label(column):
            label, since = str(column[0]), i + 1
            names.append("")
        elif label:
            length = after[since - 1]
            part = "xyz"[i - since] if length == len("xyz") else str(i - since + 1)
            names.append(label if length == 1 else f"{label}.{part}")
        else:
            names.append("")
    return names


def _length(columns: Sequence[pl.Series], start: int) -> int:
    end = next((i for i in range(start, len(columns)) if _is_label(columns[i])), len(columns))
    return end - start


def _is_label(column: pl.Series) -> bool:
    return column.dtype == pl.String and len(column) > 0 and column.n_unique() == 1 and not is_valued(str(column[0]))
