"""Lines and cells of a text table that are not like the others: left out, counted, and the first one named."""

import csv
from collections import Counter
from collections.abc import Callable, Iterator
from itertools import islice
from pathlib import Path

import numpy as np
import polars as pl

from sensorfault.logs.phrase import counted
from sensorfault.logs.readers.cells import MISSING, PADDING
from sensorfault.logs.readers.dialect import Dialect
from sensorfault.logs.readers.records import Record, records
from sensorfault.logs.table import LogError

_HOPELESS = 0.2  # share of the lines that may be left out
_NAMED = 4  # columns in one sentence
Lines = Callable[[int], int]  # row -> the line of the file that it begins in, counted from 1


def body(content: bytes, dialect: Dialect, skip: int) -> Iterator[Record]:
    """The records below the header, blank lines among them; a line break in quotes ends none."""
    lines = content.decode("utf-8-sig", "replace").split("\n")
    numbered = (
        (i, line.removesuffix("\r"))
        for i, line in enumerate(lines, 1)
        if i > skip and not (dialect.comment and line.startswith(dialect.comment))
    )
    return records(numbered, dialect.delimiter)


def lines_of(content: Callable[[], bytes], dialect: Dialect, kept: np.ndarray) -> Lines:
    """The line of each row, looked for only when one is asked for. `kept`: which records the rows are."""

    def line(row: int) -> int:
        found = next(islice(body(content(), dialect, dialect.skip), int(kept[row]), None), None)
        return found.line if found is not None else 0

    return line


def fitting_rows(path: Path, content: bytes, dialect: Dialect, skip: int) -> tuple[pl.DataFrame, list[str]]:
    """The table as text without the lines of too many cells, and a sentence on those; the lines that are left out
    are rows without a cell.

    Raises:
        LogError: a quote that does not close, or too many such lines.
    """
    width = len(dialect.names)
    rows: list[tuple[str | None, ...]] = []
    longer: list[Record] = []
    begun = last = skip
    try:
        for record in body(content, dialect, skip):
            begun, last = record.line, record.last
            if len(record.cells) > width and any(record.cells[width:]):
                longer.append(record)
                rows.append((None,) * width)
            else:
                rows.append((*record.cells[:width], *(None,) * (width - len(record.cells))))
        closed = last == begun or content.count(b'"') % 2 == 0
    except csv.Error:  # a cell that is too long
        begun, closed = last + 1, False
    if not closed:
        raise LogError(f"{path}: {open_quote(content, begun - 1)}; correct that line, or remove it.")
    frame = pl.DataFrame(rows, schema=dict.fromkeys(dialect.names, pl.String), orient="row")
    if not longer:
        return frame, []
    first = longer[0]
    said = f"{first.line} has {len(first.cells)} cells where the others have {width}"
    if len(longer) > _HOPELESS * len(rows):
        raise LogError(
            f"{path}: line {said}, and so do {len(longer)} of {len(rows)} lines; correct them, or the header."
        )
    return frame, [f"{path.name}: {counted(len(longer), 'line')} left out: line {said}."]


def open_quote(content: bytes, line: int = 0) -> str:
    """Which line below this one has a quote that does not close."""
    rest = content.split(b"\n")[line:]
    odd = next((i for i, one in enumerate(rest, line + 1) if one.count(b'"') % 2), line + 1)
    return f"line {odd} has a quote that does not close"


def odd_rows(text: pl.DataFrame, numbers: pl.DataFrame) -> np.ndarray:
    """Rows in which no cell of a column of numbers is a number, but words stand there: a header again, or a sum."""
    columns = [name for name in text.columns if numbers[name].dtype.is_numeric()]
    words, found = np.zeros(len(text), int), np.zeros(len(text), int)
    for name in columns:
        lost = _lost(text[name], numbers[name])
        words += lost
        found += numbers[name].is_not_null().to_numpy()
    odd: np.ndarray = (words >= 2) & (found == 0)
    return odd


def odd_cells(name: str, text: pl.DataFrame, numbers: pl.DataFrame, line: Lines) -> list[str]:
    """A sentence on cells that are no numbers in columns of numbers."""
    found: Counter[str] = Counter()
    first, cell = len(text), ""
    for column in text.columns:
        if numbers[column].dtype.is_numeric():
            lost = _lost(text[column], numbers[column])
            if lost.any():
                found[column] = int(lost.sum())
                if int(np.argmax(lost)) < first:
                    first, cell = int(np.argmax(lost)), str(text[column][int(np.argmax(lost))])
    if not found:
        return []
    named = ", ".join(f"'{column}' ({count})" for column, count in list(found.items())[:_NAMED])
    named += f" and {len(found) - _NAMED} other columns" if len(found) > _NAMED else ""
    return [f"{name}: cells that are no numbers in {named}, first '{cell}' in line {line(first)}; read as no value."]


def _lost(text: pl.Series, numbers: pl.Series) -> np.ndarray:
    if numbers.null_count() == text.null_count():
        return np.zeros(len(text), bool)
    plain = text.str.strip_chars(PADDING)
    lost: np.ndarray = (numbers.is_null() & plain.is_not_null() & ~plain.is_in(MISSING)).to_numpy()
    return lost


def said_of_rows(name: str, odd: np.ndarray, text: pl.DataFrame, line: Lines) -> str:
    """A sentence on rows that are none."""
    first = int(np.argmax(odd))
    words = next((str(cell) for cell in text.row(first) if cell), "")
    return f"{name}: {counted(int(odd.sum()), 'line')} without numbers left out, first line {line(first)} ('{words}')."
