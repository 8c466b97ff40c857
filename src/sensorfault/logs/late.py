"""Leaves out and counts rows of a part that are older than rows already passed on."""

from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from sensorfault.logs.clock import HOPELESS
from sensorfault.logs.entries import FileEntry
from sensorfault.logs.phrase import counted
from sensorfault.logs.readers.source import Source, Tables
from sensorfault.logs.stamps import seconds
from sensorfault.logs.table import LogError


@dataclass
class _Rows:
    """How many rows, and the place of the first."""

    count: int = 0
    first: str = ""

    def add(self, source: Source, these: np.ndarray) -> None:
        if these.any():
            self.count += int(these.sum())
            self.first = self.first or source.place(int(np.argmax(these)))


@dataclass
class _Table:
    """The table so far. `back`: rows older than its own last row; `behind`: rows older only than other tables' rows."""

    path: Path
    name: str
    column: str
    rows: int = 0
    last_s: float = -np.inf
    back: _Rows = field(default_factory=_Rows)
    behind: _Rows = field(default_factory=_Rows)


class Late:
    """Takes the parts of a file in order."""

    def __init__(self, entries: list[FileEntry]) -> None:
        self._entries = entries
        self._tables: dict[str, _Table] = {}

    def without(self, tables: Tables, handed_s: float) -> Tables:
        """The described tables without the rows up to this time on the common clock [s]."""
        named = {entry.table or "": entry for entry in self._entries}
        return {name: self._kept(one, named[name], handed_s) for name, one in tables.items() if name in named}

    def _kept(self, source: Source, entry: FileEntry, handed_s: float) -> Source:
        column = entry.time or source.time or ""
        table = self._tables.setdefault(source.table, _Table(source.path, source.name, column))
        source = replace(source, before=table.rows)
        table.rows += len(source.frame)
        if entry.tag is not None or column not in source.frame.columns:
            return source
        if not source.frame[column].dtype.is_numeric() or not source.frame[column].count():
            return source
        zero_s, time = seconds(source, entry)
        time = zero_s + entry.offset_s + time
        late = time <= handed_s
        table.back.add(source, late & (time <= table.last_s))
        table.behind.add(source, late & (time > table.last_s))
        table.last_s = float(np.fmax.reduce(time, initial=table.last_s))
        return replace(source, frame=source.frame.filter(~late)) if late.any() else source

    def notes(self) -> list[str]:
        """Notes on what was left out.

        Raises:
            LogError: too many rows were.
        """
        said = []
        for table in self._tables.values():
            back = f"time '{table.column}' goes back (first {table.back.first})"
            if table.back.count > HOPELESS * table.rows:
                raise LogError(
                    f"{table.path}: {back}, so {table.back.count} of {table.rows} rows are out of order; cut the file "
                    "there, or name another time column."
                )
            if table.back.count:
                said.append(f"{table.name}: {back}; {counted(table.back.count, 'row')} left out.")
            if table.behind.count:
                lost = f"{counted(table.behind.count, 'row')} (first {table.behind.first})"
                said.append(
                    f"{table.name}: {lost} come much later than rows of other tables with the same time; left out."
                )
        return said
