"""CSV and its kin: comma, semicolon, tab or blanks between the cells, with a header or without."""

import re
from dataclasses import replace
from pathlib import Path
from typing import Literal

import polars as pl

from sensorfault.logs.readers.dialect import MISSING, Dialect, is_number, sniff
from sensorfault.logs.readers.format import Format, in_parts
from sensorfault.logs.readers.source import Ask, Source
from sensorfault.logs.readers.times_apart import table_timed, times_beside, with_times
from sensorfault.logs.table import LogError

_PADDING = ' \t\r"'
_SAMPLE_ROWS = 1000
_PART_BYTES = 1 << 24
_EXACT_IN_FLOAT = 2**53
Holds = Literal["text", "whole", "number"]  # what a column's cells are; whole: a float would round them
_DTYPES = {"text": pl.String(), "whole": pl.Int64(), "number": pl.Float64()}
_HOLDS: dict[pl.DataType, Holds] = {pl.String(): "text", pl.Int64(): "whole", pl.Float64(): "number"}


def read_csv(path: Path) -> Source:
    """One text table, with its times where they lie beside it. Columns of a headerless file are called c1, c2, ...

    Raises:
        LogError: empty, not text, or not a table.
    """
    dialect = sniff(path)
    content, skip = _content(path, dialect)
    return with_times(_source(path, dialect, _table(path, content, dialect, skip)))


def rest_of_csv(path: Path, ask: Ask) -> Source:
    """The last lines of a text table, once all before them have been handed on to `ask.part`; the whole if times lie
    beside it.

    Raises:
        LogError: as `read_csv`.
    """
    assert ask.part is not None
    dialect = sniff(path)
    if times_beside(path, dialect.names) is not None:
        return read_csv(path)
    line, size, before, holds = dialect.skip + 1, path.stat().st_size, None, None
    with path.open("rb") as file:
        for _ in range(dialect.skip):
            file.readline()
        while lines := file.readlines(_PART_BYTES):
            if before is not None:
                ask.part({"": Source(path, _not_blank(before), first_line=line)})
                line += len(before)
            content = b"".join(lines) if dialect.delimiter is not None else _even(lines)
            before = _table(path, content, dialect, 0, holds)
            holds = [_HOLDS[dtype] for dtype in before.dtypes]
            ask.tell(file.tell() / size)
    assert before is not None  # a dialect has a row
    return replace(_source(path, dialect, before), first_line=line)


def _table(
    path: Path, content: Path | bytes, dialect: Dialect, skip: int, holds: list[Holds] | None = None
) -> pl.DataFrame:
    try:
        return _parse(content, dialect, skip, holds or _holds(content, dialect, skip))
    except pl.exceptions.PolarsError:
        # Some cell is not what the first rows promised: read all as text and keep what is not a number as it is.
        return _numbers(_parse_text(path, content, dialect, skip))


def _source(path: Path, dialect: Dialect, frame: pl.DataFrame) -> Source:
    """The rows of the table, or its last, without a line that is cut off."""
    notes = []
    if dialect.first_cut:
        notes.append(f"{path.name}: the first line is cut off and was left out.")
    if _last_cut(path, dialect, frame):
        frame = frame[:-1]
        notes.append(f"{path.name}: the last line is cut off and was left out.")
    return Source(path, _not_blank(frame), first_line=dialect.skip + 1, notes=tuple(notes))


def _not_blank(frame: pl.DataFrame) -> pl.DataFrame:
    blank = frame.select(pl.all_horizontal(pl.all().is_null())).to_series()
    return frame.filter(~blank) if blank.any() else frame


def _content(path: Path, dialect: Dialect) -> tuple[Path | bytes, int]:
    """The file itself, or its bytes with one comma for each run of blanks: polars wants one delimiter byte."""
    if dialect.delimiter is not None:
        return path, dialect.skip
    return _even(path.read_bytes().splitlines()[dialect.skip :]), 0


def _even(lines: list[bytes]) -> bytes:
    return b"\n".join(re.sub(rb"[ \t]+", b",", line.strip()) for line in lines)


def _parse(
    content: Path | bytes, dialect: Dialect, skip: int, holds: list[Holds], rows: int | None = None
) -> pl.DataFrame:
    return pl.read_csv(
        content,
        has_header=False,
        skip_lines=skip,
        separator=dialect.delimiter or ",",
        new_columns=list(dialect.names),
        schema_overrides={name: _DTYPES[cells] for name, cells in zip(dialect.names, holds, strict=True)},
        comment_prefix=dialect.comment,
        decimal_comma=dialect.decimal_comma and dialect.delimiter is not None,
        null_values=list(MISSING),
        encoding="utf8-lossy",
        n_rows=rows,
        glob=False,
    )


def _holds(content: Path | bytes, dialect: Dialect, skip: int) -> list[Holds]:
    """Float for numbers; integers stay integers only where a float would round them (nanoseconds since 1970)."""
    sample = _parse(content, dialect, skip, ["text"] * len(dialect.names), _SAMPLE_ROWS)
    return [_content_of(column) for column in sample]


def _content_of(column: pl.Series) -> Holds:
    cells = [cell.strip(_PADDING) for cell in column.drop_nulls()]
    cells = [cell for cell in cells if cell not in MISSING]
    if not all(is_number(cell) for cell in cells):
        return "text"
    whole = all(re.fullmatch(r"[+-]?\d{1,19}", cell) for cell in cells)
    return "whole" if whole and any(abs(int(cell)) > _EXACT_IN_FLOAT for cell in cells) else "number"


def _parse_text(path: Path, content: Path | bytes, dialect: Dialect, skip: int) -> pl.DataFrame:
    try:
        return _parse(content, dialect, skip, ["text"] * len(dialect.names))
    except pl.exceptions.PolarsError:
        raise LogError(f"{path}: {_odd_line(path, dialect)}; mend that line, or take it out.") from None


def _odd_line(path: Path, dialect: Dialect) -> str:
    """What is wrong with the first line that does not fit; looked for only once reading has failed."""
    width = len(dialect.names)
    with path.open(encoding="utf-8", errors="replace") as file:
        for number, line in enumerate(file, 1):
            if number <= dialect.skip or (dialect.comment and line.startswith(dialect.comment)):
                continue
            if line.count('"') % 2:
                return f"line {number} has a quote that does not close"
            cells = len(dialect.split(line))
            if cells > width:
                return f"line {number} has {cells} cells where the others have {width}"
    return f"some line does not fit a table of {width} columns"


def _numbers(frame: pl.DataFrame) -> pl.DataFrame:
    """Text columns become numbers where every cell is one."""
    columns = []
    for column in frame:
        text = column.str.strip_chars(_PADDING)
        text = text.set(text.is_in(MISSING), None)
        number = text.cast(pl.Float64, strict=False)
        columns.append(number if number.null_count() == text.null_count() else text)
    return pl.DataFrame(columns)


def _last_cut(path: Path, dialect: Dialect, frame: pl.DataFrame) -> bool:
    """Whether the file ends inside its last line: power was lost, and the last cell may be half a number."""
    with path.open("rb") as file:
        size = file.seek(0, 2)
        file.seek(max(0, size - (1 << 16)))
        tail = file.read().decode("utf-8", "replace")
    if tail.endswith(("\n", "\r")) or len(frame) < 2:
        return False
    return len(dialect.split(tail.splitlines()[-1])) < len(dialect.names)


FORMAT = Format(
    "text table", ("*.csv", "*.tsv", "*.txt", "*.dat"), in_parts(read_csv, rest_of_csv), leader=table_timed, parts=True
)
