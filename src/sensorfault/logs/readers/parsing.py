"""The rows of a text table: polars reads them, with a second way for cells and lines that are unlike the others."""

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np
import polars as pl

from sensorfault.logs.readers.cells import MISSING, PADDING, STAMP, is_number, numbers_of
from sensorfault.logs.readers.dialect import Dialect
from sensorfault.logs.readers.odd import fitting_rows, lines_of, odd_cells, odd_rows, open_quote, said_of_rows
from sensorfault.logs.readers.text import plain_bytes
from sensorfault.logs.table import LogError

_SAMPLE_ROWS = 1000
_EXACT_IN_FLOAT = 2**53
_COMMON = ("", "NA", "N/A", "null", "None", "-")  # of the cells that mean no value
Holds = Literal["text", "whole", "number"]  # what a column's cells are; whole: a float would round them
_DTYPES = {"text": pl.String(), "whole": pl.Int64(), "number": pl.Float64()}
HOLDS: dict[pl.DataType, Holds] = {pl.String(): "text", pl.Int64(): "whole", pl.Float64(): "number"}


def table(
    path: Path, content: Path | bytes, dialect: Dialect, skip: int, holds: list[Holds] | None = None
) -> tuple[pl.DataFrame, list[str], np.ndarray | None]:
    """The rows with their numbers, sentences on what was left out, and which records the rows are; None: all."""
    holds = holds or _holds(content, dialect, skip)
    if holds is not None:
        try:
            frame = _closed(path, content, _parse(content, dialect, skip, holds, missing=_COMMON))
        except pl.exceptions.PolarsError:
            holds = None  # a cell is not of the type of the first rows, or a line is longer than they are
        else:
            blank = frame.select(pl.all_horizontal(pl.all().is_null())).to_series()
            return (frame.filter(~blank), [], np.flatnonzero(~blank.to_numpy())) if blank.any() else (frame, [], None)
    return _numbers(path, *_text(path, content, dialect, skip), content, dialect)


def _text(path: Path, content: Path | bytes, dialect: Dialect, skip: int) -> tuple[pl.DataFrame, list[str]]:
    try:
        return _closed(path, content, _parse(content, dialect, skip, ["text"] * len(dialect.names))), []
    except pl.exceptions.PolarsError:
        pass
    return fitting_rows(path, bytes_of(content), replace(dialect, delimiter=_separator(dialect)), skip)


def _closed(path: Path, content: Path | bytes, frame: pl.DataFrame) -> pl.DataFrame:
    """The same table.

    Raises:
        LogError: a quote that does not close has taken in the last lines.
    """
    last = frame.row(-1) if len(frame) else ()
    if any(isinstance(cell, str) and "\n" in cell for cell in last) and bytes_of(content).count(b'"') % 2:
        raise LogError(f"{path}: {open_quote(bytes_of(content))}; correct that line, or remove it.")
    return frame


def _numbers(
    path: Path, text: pl.DataFrame, notes: list[str], content: Path | bytes, dialect: Dialect
) -> tuple[pl.DataFrame, list[str], np.ndarray | None]:
    """Text as numbers, column by column; rows that are none are left out."""
    blank = text.select(pl.all_horizontal(pl.all().is_null())).to_series().to_numpy()
    kept = np.flatnonzero(~blank)
    text = text[kept] if blank.any() else text
    comma = dialect.decimal_comma
    numbers = pl.DataFrame([_whole(column, numbers_of(column, comma)) for column in text])
    odd = odd_rows(text, numbers)
    if odd.any():
        notes = [*notes, said_of_rows(path.name, odd, text, lines_of(lambda: bytes_of(content), dialect, kept))]
        kept, text = kept[~odd], text.filter(~odd)
        numbers = pl.DataFrame([_whole(column, numbers_of(column, comma)) for column in text])
    line = lines_of(lambda: bytes_of(content), dialect, kept)
    return numbers, [*notes, *odd_cells(path.name, text, numbers, line)], kept


def _whole(text: pl.Series, number: pl.Series) -> pl.Series:
    """Integers stay integers where a float would round them."""
    if not number.dtype.is_float() or not (number.abs() > _EXACT_IN_FLOAT).any():
        return number
    whole = text.str.strip_chars(PADDING).cast(pl.Int64, strict=False)
    return whole if whole.null_count() == number.null_count() else number


def content_of_file(path: Path, dialect: Dialect) -> Path | bytes:
    """The file itself; or its bytes with line feeds, or a tabulator for each run of blanks."""
    if dialect.text.plain and dialect.delimiter is not None:
        return path
    content = plain_bytes(path, dialect.text)
    return content if dialect.delimiter is not None else even(content)


def bytes_of(content: Path | bytes) -> bytes:
    """The bytes of a file, or those that were read of it."""
    return content.read_bytes() if isinstance(content, Path) else content


def _separator(dialect: Dialect) -> str:
    return dialect.delimiter or "\t"


def even(content: bytes) -> bytes:
    """The same lines with a tabulator for each run of blanks; quotes keep theirs."""
    if b'"' not in content:
        return b"\n".join(re.sub(rb"[ \t]+", b"\t", line.strip()) for line in content.split(b"\n"))
    return b"\n".join(b"\t".join(re.findall(rb'"(?:[^"]|"")*"|\S+', line)) for line in content.split(b"\n"))


def _parse(
    content: Path | bytes,
    dialect: Dialect,
    skip: int,
    holds: list[Holds],
    rows: int | None = None,
    missing: Sequence[str] = MISSING,
) -> pl.DataFrame:
    """`missing`: cells without a value; each costs time in every cell."""
    return pl.read_csv(
        content,
        has_header=False,
        skip_lines=skip,
        separator=_separator(dialect),
        new_columns=list(dialect.names),
        schema_overrides={name: _DTYPES[cells] for name, cells in zip(dialect.names, holds, strict=True)},
        comment_prefix=dialect.comment,
        decimal_comma=dialect.decimal_comma and dialect.delimiter != ",",
        null_values=list(missing),
        encoding="utf8-lossy",
        n_rows=rows,
        glob=False,
    )


def _holds(content: Path | bytes, dialect: Dialect, skip: int) -> list[Holds] | None:
    """What each column holds, by its first rows; None if a cell is no plain number in a column of numbers."""
    try:
        sample = _parse(content, dialect, skip, ["text"] * len(dialect.names), _SAMPLE_ROWS)
    except pl.exceptions.PolarsError:
        return None
    found = [_content_of(column, dialect.decimal_comma) for column in sample]
    return None if None in found else [one for one in found if one is not None]


def _content_of(column: pl.Series, comma: bool) -> Holds | None:
    """Float for numbers; integers stay integers only where a float would round them (nanoseconds since 1970)."""
    cells = [cell.strip(PADDING) for cell in column.drop_nulls()]
    cells = [cell for cell in cells if cell not in MISSING]
    if cells and all(re.match(STAMP, cell) for cell in cells):
        return "text"
    sign = "," if comma else "."
    plain = re.compile(rf"[+-]?(\d+([{sign}]\d*)?|[{sign}]\d+)([eE][+-]?\d+)?|[+-]?(nan|inf|infinity)", re.IGNORECASE)
    simple = sum(plain.fullmatch(cell) is not None for cell in cells)
    if simple < len(cells):
        numbers = sum(is_number(cell) or "∞" in cell for cell in cells)
        return None if 2 * numbers > len(cells) else "text"
    whole = all(re.fullmatch(r"[+-]?\d{1,19}", cell) for cell in cells)
    return "whole" if whole and any(abs(int(cell)) > _EXACT_IN_FLOAT for cell in cells) else "number"
