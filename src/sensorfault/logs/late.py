"""Rows of a part whose clock has gone back behind what was handed on before: they are left out, and counted."""

from dataclasses import dataclass, replace

import numpy as np

from sensorfault.logs.clock import HOPELESS, seconds
from sensorfault.logs.entries import FileEntry
from sensorfault.logs.phrase import counted
from sensorfault.logs.readers.source import Source, Tables
from sensorfault.logs.table import LogError


@dataclass
class _Table:
    """Rows of it: all, those left out, and where the first of those stands."""

    source: Source
    column: str
    begin_s: float | None = None
    rows: int = 0
    late: int = 0
    first: str = ""


class Late:
    """Hears the parts of a file in turn."""

    def __init__(self, entries: list[FileEntry]) -> None:
        self._entries = entries
        self._tables: dict[str, _Table] = {}

    def without(self, tables: Tables, handed_s: float) -> Tables:
        """The described tables without rows of times up to this, on the common clock [s]."""
        named = {entry.table or "": entry for entry in self._entries}
        return {name: self._kept(one, named[name], handed_s) for name, one in tables.items() if name in named}

    def _kept(self, source: Source, entry: FileEntry, handed_s: float) -> Source:
        column, unit = entry.time or source.time or "", source.unit or entry.unit
        table = self._tables.setdefault(source.table, _Table(source, column))
        source = replace(source, before=table.rows, begin_s=table.begin_s)
        table.rows += len(source.frame)
        if entry.tag is not None or column not in source.frame.columns:
            return source
        if not source.frame[column].dtype.is_numeric() or not source.frame[column].count():
            return source
        zero_s, time = seconds(source, column, unit)
        if table.begin_s is None:
            table.begin_s = zero_s
        late = zero_s + entry.offset_s + time <= handed_s
        if not late.any():
            return source
        table.late += int(late.sum())
        table.first = table.first or source.place(int(np.argmax(late)))
        return replace(source, frame=source.frame.filter(~late))

    def notes(self) -> list[str]:
        """What was left out.

        Raises:
            LogError: it is too much.
        """
        said = []
        for table in self._tables.values():
            back = f"time '{table.column}' goes back (first {table.first})"
            if table.late > HOPELESS * table.rows:
                raise LogError(
                    f"{table.source.path}: {back}, so {table.late} of {table.rows} rows are out of order; cut the file "
                    "there, or name another time column."
                )
            if table.late:
                lost = counted(table.late, "row")
                said.append(f"{table.source.name}: {back}; {lost} left out.")
        return said
