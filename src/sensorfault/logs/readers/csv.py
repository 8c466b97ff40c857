"""CSV and similar: comma, semicolon, tab or blanks between the cells, with a header or without."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl

from sensorfault.logs.readers.dialect import Dialect, sniff
from sensorfault.logs.readers.format import Format, remembering
from sensorfault.logs.readers.kinds import kind_column, of_kinds, records_of_kinds
from sensorfault.logs.readers.odd import lines_of
from sensorfault.logs.readers.parsing import HOLDS, bytes_of, content_of_file, even, table
from sensorfault.logs.readers.source import Ask, Source, Tables
from sensorfault.logs.readers.times_apart import table_timed, times_beside, with_times
from sensorfault.logs.table import LogError
from sensorfault.logs.time_units import TIME_WORDS
from sensorfault.logs.units import known, spelled

_PART_BYTES = 1 << 24


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
    content = content_of_file(path, dialect)
    frame, notes, kept = table(path, content, dialect, dialect.skip)
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
            content = content if dialect.delimiter is not None else even(content)
            frame, notes, kept = table(path, content, dialect, 0, holds)
            holds = [HOLDS[dtype] for dtype in frame.dtypes]
            before = replace(_source(path, dialect, frame, notes, kept), first_line=line, lines=None)
            kind = kind_column(frame, dialect.headerless) if line == dialect.skip + 1 else kind
            line += len(lines)
            ask.tell(file.tell() / size)
    assert before is not None  # a dialect has a row
    return of_kinds(before, kind)


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
    lines = None if simple else lines_of(lambda: bytes_of(content_of_file(path, dialect)), dialect, rows)
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
    last = tail.splitlines()[-1]
    remark = dialect.comment is not None and last.lstrip().startswith(dialect.comment)
    return not remark and len(dialect.split(last)) < len(dialect.names) - len(dialect.unnamed)


FORMAT = Format(
    "text table",
    ("*.csv", "*.tsv", "*.txt", "*.dat"),
    remembering(read_tables_of_text),
    leader=table_timed,
    parts=True,
)
