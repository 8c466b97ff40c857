"""Joins the parts of a long file to consecutive pieces of one log."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from sensorfault.logs.entries import FileEntry
from sensorfault.logs.jumps import distinct
from sensorfault.logs.late import Late
from sensorfault.logs.one_clock import Piece, put_on_one_clock
from sensorfault.logs.pauses import GAP, Pauses, pauses_of, pauses_said
from sensorfault.logs.readers.source import Source, Tables, joined
from sensorfault.logs.reading import log_of, widened
from sensorfault.logs.reading_notes import ReadingNotes
from sensorfault.logs.stream import read_stream
from sensorfault.logs.table import Log, LogError
from sensorfault.logs.vehicle import VehicleFile

MARGIN_S = 5.0  # the last seconds of a part go to the next part: rows of a slow topic may still belong to them
_STAYS = 0.8  # the ticks stay with their stream unless another stream is faster by this factor
MOST_SAID = 20  # most notes that are kept; each part has its own


@dataclass
class Joining:
    """Joins each part to the one before it, makes a log of both, and passes on its new rows."""

    path: Path
    known: VehicleFile
    entries: list[FileEntry]
    hand_on: Callable[[Log], None]
    before: Tables = field(default_factory=dict)
    handed_s: float = -np.inf  # up to here
    seen_s: float = -np.inf  # the last tick of the parts before
    begin_s: float | None = None  # the first tick's reading
    ticks: str | None = None  # the stream whose rows they are
    damage: dict[str, None] = field(default_factory=dict)
    notes: dict[str, None] = field(default_factory=dict)
    more: int = 0
    pauses: Pauses = field(default_factory=lambda: np.zeros((0, 2)))

    def __post_init__(self) -> None:
        self._late = Late(self.entries)

    def take(self, tables: Tables, last: bool = False) -> None:
        """The tables of the next part."""
        self.damage |= dict.fromkeys(one.sentence(self.path) for source in tables.values() for one in source.damage)
        tables = self._late.without(tables, self.handed_s + (self.known.zero_s or 0.0))
        both = joined(self.before, tables)
        new = {name for name, source in tables.items() if len(source.frame)}
        log = self._log(both, new, last) if new or last else None
        if log is None:
            self.before = both
            return
        self.before = {name: _recent(one, tables.get(name)) for name, one in both.items()}
        end_s = _settled_s(log)
        begin_s = max(self.seen_s, float(log.time[0]))
        self.seen_s = end_s
        until = np.inf if last else end_s - min(MARGIN_S, (end_s - begin_s) / 2)
        for note in log.notes:
            self._note(note)
        self._hand_on(log, (log.time > self.handed_s + log.period_s / 2) & (log.time <= until))

    def _hand_on(self, log: Log, new: np.ndarray) -> None:
        if new.any():
            rows = slice(int(np.argmax(new)), len(new) - int(np.argmax(new[::-1])))
            part = replace(log, time=log.time[rows], value=log.value[rows], fresh=log.fresh[rows], notes=())
            jumps = distinct(self._late.jumps(self.known.zero_s or 0.0))
            part = replace(part, jumps=tuple(j for j in jumps if self.handed_s < j.time_s <= part.time[-1]))
            ticks = np.append(self.handed_s, part.time) if np.isfinite(self.handed_s) else part.time
            self.pauses = np.concatenate([self.pauses, pauses_of(ticks, log.period_s)])
            self.handed_s = float(part.time[-1])
            self.hand_on(part)

    def said(self, first: tuple[str, ...]) -> ReadingNotes:
        """All notes; `first`: notes that come first."""
        if not np.isfinite(self.seen_s):
            raise LogError(f"{self.path}: one row is no log; name a file with at least two rows at different times.")
        for note in self._late.notes():
            self._note(note)
        more = [f"{self.path.name}: {self.more} more notes on its parts."] if self.more else []
        paused = pauses_said(self.pauses)
        notes = dict.fromkeys((*self.damage, *first, *self.notes, *more, *paused))
        return ReadingNotes(tuple(notes), tuple(self.damage))

    def _note(self, note: str) -> None:
        if len(self.notes) < MOST_SAID or note in self.notes:
            self.notes[note] = None
        else:
            self.more += 1

    def _log(self, tables: Tables, new: set[str], last: bool) -> Log | None:
        """The described log, as far as its tables are there; sensors of missing tables have no values. None if no
        table is there.

        `new`: the tables with rows since the part before.
        """
        streams, there, able = [], [], []
        for entry in self.entries:
            source = tables.get(entry.table or "", None)
            if source is not None and len(source.frame) > 1:
                mine = [sensor for sensor in self.known.sensors if sensor.file == entry.name]
                # Period None is measured from the log; 0 is too, but allows a part without measurements.
                quiet = tuple(replace(sensor, period_s=sensor.period_s or 0.0) for sensor in mine)
                streams.append(read_stream(source, entry, quiet))
                there.append(entry.name)
                able += [streams[-1]] if (entry.table or "") in new else []
        if not streams:
            return None
        present = replace(self.known, sensors=tuple(s for s in self.known.sensors if s.file in there))
        fastest = min(able or streams, key=lambda one: one.pace_s * (_STAYS if one.name == self.ticks else 1))
        self.ticks = fastest.name
        begin_s = fastest.zero_s if self.begin_s is None else self.begin_s
        since_s = self.handed_s + (self.known.zero_s or 0.0)
        clock = put_on_one_clock(streams, piece=Piece(fastest, begin_s, self.begin_s is None, last, since_s))
        self.begin_s = begin_s
        if self.known.zero_s is None:  # the first part begins the log
            self.known = replace(self.known, zero_s=clock.zero_s + float(clock.time[0]))
            present = replace(present, zero_s=self.known.zero_s)
        notes = (*clock.notes, *(note for stream in streams for note in stream.notes))
        return widened(log_of(present, streams, clock, (), notes), self.known)


def _settled_s(log: Log) -> float:
    """The last tick; the one before it where the last may be a wrong reading far ahead."""
    wild = len(log) > 2 and log.time[-1] - log.time[-2] > max(MARGIN_S, GAP * log.period_s)
    return float(log.time[-2] if wild else log.time[-1])


def _recent(both: Source, now: Source | None) -> Source:
    """The rows of this part, but at least two, as the next row of a slow table may come much later."""
    if now is not None and len(now.frame) > 1:
        return now
    return replace(both, frame=both.frame.tail(2), before=both.before + max(0, len(both.frame) - 2))
