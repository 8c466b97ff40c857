"""Leaves out and counts rows of a part that are older than rows already passed on."""

from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import polars as pl
from jaxtyping import Float

from sensorfault.logs.clock import HOPELESS
from sensorfault.logs.clock_steps import continued, steps, wraps
from sensorfault.logs.entries import FileEntry
from sensorfault.logs.jumps import Jump
from sensorfault.logs.phrase import counted
from sensorfault.logs.readers.source import Source, Tables
from sensorfault.logs.stamps import MENDED, read_seconds
from sensorfault.logs.table import LogError

_RECENT = 200  # times of a table that are kept from part to part, so that a jump at a seam is seen


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
    """The table so far. `back`: rows older than its own last row; `behind`: rows older only than other tables' rows.

    `mended_s`: what is added to its clock since the last jump of it [s]. `recent`: its last times, mended.
    """

    path: Path
    name: str
    column: str
    rows: int = 0
    last_s: float = -np.inf
    begun_s: float = np.nan
    mended_s: float = 0.0
    recent: Float[np.ndarray, " n"] = field(default_factory=lambda: np.zeros(0))
    jumps: list[Jump] = field(default_factory=list)
    back: _Rows = field(default_factory=_Rows)
    behind: _Rows = field(default_factory=_Rows)

    def mended(self, source: Source, time: np.ndarray) -> tuple[Source, np.ndarray]:
        """The next rows and their times, without the jumps of the clock; the rows keep what is added to their times."""
        if np.isnan(self.begun_s) and len(time):
            self.begun_s = float(time[0])
        before = len(self.recent)
        both = np.concatenate([self.recent, time + self.mended_s])
        jumped = [one for one in steps(source, both, before, self.begun_s) if one.row >= before]
        added, read = continued(both, jumped)[before:] - time, time
        time = time + added
        self.jumps += [
            Jump(float(time[one.row - before]), -one.back_s, self.column)
            for one in jumped
            if not wraps(float(read[one.row - before]), one.step_s)
        ]
        finite = added[np.isfinite(added)]
        self.mended_s = float(finite[-1]) if len(finite) else self.mended_s
        self.recent = np.concatenate([self.recent, time])[-_RECENT:]
        if not (finite != 0).any():
            return source, time
        return replace(source, frame=source.frame.with_columns(pl.Series(MENDED, np.nan_to_num(added)))), time


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
        zero_s, time = read_seconds(source, entry)
        source, time = table.mended(source, zero_s + entry.offset_s + time)
        late = time <= handed_s
        table.back.add(source, late & (time <= table.last_s))
        table.behind.add(source, late & (time > table.last_s))
        table.last_s = float(np.fmax.reduce(time, initial=table.last_s))
        return replace(source, frame=source.frame.filter(~late)) if late.any() else source

    def jumps(self, zero_s: float) -> list[Jump]:
        """Jumps of all tables' clocks so far, at times since `zero_s`."""
        return [replace(one, time_s=one.time_s - zero_s) for table in self._tables.values() for one in table.jumps]

    def notes(self) -> list[str]:
        """Notes on what was left out.

        Raises:
            LogError: too many rows were.
        """
        said = []
        for table in self._tables.values():
            said += [
                f"{table.name}: {one.said}; from there on it is continued without the jump." for one in table.jumps
            ]
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
