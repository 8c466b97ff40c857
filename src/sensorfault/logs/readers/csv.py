"""CSV and similar: comma, semicolon, tab or blanks between the cells, with a header or without."""

import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np
import polars as pl

from sensorfault.logs.readers.cells import MISSING, PADDING, is_number, numbers_of
from sensorfault.logs.readers.dialect import Dialect, sniff
from sensorfault.logs.readers.format import Format
from sensorfault.logs.readers.kinds import kind_column, of_kinds, records_of_kinds
from sensorfault.logs.readers.odd import fitting_rows, lines_of, odd_cells, odd_rows, open_quote, said_of_rows
from sensorfault.logs.readers.source import Ask, Source, Tables
from sensorfault.logs.readers.text import plain_bytes
from sensorfault.logs.readers.times_apart import table_timed, times_beside, with_times
from sensorfault.logs.table import LogError
from sensorfault.logs.time_units import TIME_WORDS
from sensorfault.logs.units import known, spelled

_SAMPLE_ROWS = 1000
_PART_BYTES = 1 << 24
_EXACT_IN_FLOAT = 2**53
_COMMON = ("", "NA", "N/A", "null", "None", "-")  # of the cells that mean no value
Holds = Literal["text", "whole", "number"]  # what a column's cells are; whole: a float would round them
_DTYPES = {"text": pl.String(), "whole": pl.Int64(), "number": pl.Float64()}
_HOLDS: dict[pl.DataType, Holds] = {pl.String(): "text", pl.Int64(): "whole", pl.Float64(): "number"}


def read_csv(path: Path) -> Source:
    """One text table, with its times if they are in a file beside it. Columns without a header are called c1, c2, ...

    Raises:
        LogError: empty, not text, or not one table.
    """
    dialect = sniff(path)
    if dialect.kinds:
        raise LogError(
            f"{path}: its lines are records of several kinds; only `sensorfault init` and `read` split them."
        )
    content = _content(path, dialect)
    frame, notes, kept = _table(path, content, dialect, dialect.skip)
    return with_times(_source(path, dialect, frame, notes, kept))


def read_tables_of_text(path: Path, ask: Ask) -> Tables:
    """The table of a file, or one for each kind of its records; in parts, if that is asked for.

    Raises:
        LogError: as `read_csv`.
    """
    dialect = sniff(path)
    if dialect.kinds:
        return records_of_kinds(path, dialect)
    if ask.part is not None and dialect.text.plain and times_beside(path, dialect.names) is None:
        return _rest(path, dialect, ask)
    source = read_csv(path)
    return of_kinds(source, kind_column(source.frame, dialect.headerless))


def _rest(path: Path, dialect: Dialect, ask: Ask) -> Tables:
    """The tables of the last lines, after all others went to `ask.part`."""
    assert ask.part is not None
    line, size, before, holds, kind = dialect.skip + 1, path.stat().st_size, None, None, None
    with path.open("rb") as file:
        for _ in range(dialect.skip):
            file.readline()
        while lines := file.readlines(_PART_BYTES):
            while sum(one.count(b'"') for one in lines) % 2 and (more := file.readline()):
                lines.append(more)  # a cell with a line break
            if before is not None:
                ask.part(of_kinds(before, kind))
            content = b"".join(lines)
            content = content if dialect.delimiter is not None else _even(content)
            frame, notes, kept = _table(path, content, dialect, 0, holds)
            holds = [_HOLDS[dtype] for dtype in frame.dtypes]
            before = replace(_source(path, dialect, frame, notes, kept), first_line=line, lines=None)
            kind = kind_column(frame, dialect.headerless) if line == dialect.skip + 1 else kind
            line += len(lines)
            ask.tell(file.tell() / size)
    assert before is not None  # a dialect has a row
    return of_kinds(before, kind)


def _table(
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
    return fitting_rows(path, _bytes(content), replace(dialect, delimiter=_separator(dialect)), skip)


def _closed(path: Path, content: Path | bytes, frame: pl.DataFrame) -> pl.DataFrame:
    """The same table.

    Raises:
        LogError: a quote that does not close has taken in the last lines.
    """
    last = frame.row(-1) if len(frame) else ()
    if any(isinstance(cell, str) and "\n" in cell for cell in last) and _bytes(content).count(b'"') % 2:
        raise LogError(f"{path}: {open_quote(_bytes(content))}; correct that line, or remove it.")
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
        notes = [*notes, said_of_rows(path.name, odd, text, lines_of(lambda: _bytes(content), dialect, kept))]
        kept, text = kept[~odd], text.filter(~odd)
        numbers = pl.DataFrame([_whole(column, numbers_of(column, comma)) for column in text])
    line = lines_of(lambda: _bytes(content), dialect, kept)
    return numbers, [*notes, *odd_cells(path.name, text, numbers, line)], kept


def _whole(text: pl.Series, number: pl.Series) -> pl.Series:
    """Integers stay integers where a float would round them."""
    if not number.dtype.is_float() or not (number.abs() > _EXACT_IN_FLOAT).any():
        return number
    whole = text.str.strip_chars(PADDING).cast(pl.Int64, strict=False)
    return whole if whole.null_count() == number.null_count() else number


def _source(path: Path, dialect: Dialect, frame: pl.DataFrame, notes: list[str], kept: np.ndarray | None) -> Source:
    """The rows of the table, or its last, without a line that is cut off."""
    notes = list(notes)
    if dialect.first_cut:
        notes.append(f"{path.name}: the first line is cut off and was left out.")
    if _last_cut(path, dialect, frame):
        frame = frame[:-1]
        notes.append(f"{path.name}: the last line is cut off and was left out.")
    frame = frame.drop([name for name in dialect.unnamed if frame[name].null_count() == len(frame)])
    simple = kept is None and dialect.comment is None
    rows = np.arange(len(frame)) if kept is None else kept
    lines = None if simple else lines_of(lambda: _bytes(_content(path, dialect)), dialect, rows)
    units = {
        name: said
        for name, cell in zip(dialect.names, dialect.units, strict=False)
        if name in frame.columns and (said := _unit(cell))
    }
    return Source(path, frame, first_line=dialect.skip + 1, notes=tuple(notes), units=units, lines=lines)


def _unit(cell: str) -> str:
    """A unit that the header has below a name."""
    bare = cell.strip("[]() ")
    return TIME_WORDS.get(bare) or (spelled(bare) if known(bare) else "")


def _content(path: Path, dialect: Dialect) -> Path | bytes:
    """The file itself; or its bytes with line feeds, or a tabulator for each run of blanks."""
    if dialect.text.plain and dialect.delimiter is not None:
        return path
    content = plain_bytes(path, dialect.text)
    return content if dialect.delimiter is not None else _even(content)


def _bytes(content: Path | bytes) -> bytes:
    return content.read_bytes() if isinstance(content, Path) else content


def _separator(dialect: Dialect) -> str:
    return dialect.delimiter or "\t"


def _even(content: bytes) -> bytes:
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
    sign = "," if comma else "."
    plain = re.compile(rf"[+-]?(\d+([{sign}]\d*)?|[{sign}]\d+)([eE][+-]?\d+)?|[+-]?(nan|inf|infinity)", re.IGNORECASE)
    simple = sum(plain.fullmatch(cell) is not None for cell in cells)
    if simple < len(cells):
        numbers = sum(is_number(cell) or "∞" in cell for cell in cells)
        return None if 2 * numbers > len(cells) else "text"
    whole = all(re.fullmatch(r"[+-]?\d{1,19}", cell) for cell in cells)
    return "whole" if whole and any(abs(int(cell)) > _EXACT_IN_FLOAT for cell in cells) else "number"


def _last_cut(path: Path, dialect: Dialect, frame: pl.DataFrame) -> bool:
    """Whether the file ends inside its last line: power was lost, and the last cell may be half a number."""
    if not dialect.text.plain:
        return False
    with path.open("rb") as file:
        size = file.seek(0, 2)
        file.seek(max(0, size - (1 << 16)))
        tail = file.read().decode("utf-8", "replace")
    if tail.endswith(("\n", "\r")) or len(frame) < 2:
        return False
    return len(dialect.split(tail.splitlines()[-1])) < len(dialect.names) - len(dialect.unnamed)


FORMAT = Format("text table", ("*.csv", "*.tsv", "*.txt", "*.dat"), read_tables_of_text, leader=table_timed, parts=True)
