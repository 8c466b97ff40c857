"""What one file of a log holds: which of its tables are sensors, and what."""

import re
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path

from sensorfault.logs.clock import Clock, read_clock
from sensorfault.logs.entries import FileEntry, SensorEntry
from sensorfault.logs.guess.autopilots import PX4, Stock, recognised
from sensorfault.logs.guess.columns import measurements
from sensorfault.logs.guess.naming import stem_of
from sensorfault.logs.guess.sensors import guess_sensors
from sensorfault.logs.guess.time import guess_time
from sensorfault.logs.place import entry_path
from sensorfault.logs.readers.beginning import is_long, read_beginning
from sensorfault.logs.readers.formats import read_tables
from sensorfault.logs.readers.source import Ask, Source, Tables
from sensorfault.logs.table import SAID, LogError

_COMMAND = re.compile(r"(^|[_/])(cmd|command|setpoint|goal|target|desired)([_/]|$)", re.IGNORECASE)
_ROWS = 500_000  # a guess looks at so many rows from the beginning
NAMES_SHOWN = 8  # of what is left out


@dataclass(frozen=True)
class Guess:
    """One table: its clock and the sensors in it. `times`: the file that its times stand in, where that is another."""

    path: Path
    columns: tuple[str, ...]
    file: FileEntry
    clock: Clock
    sensors: list[SensorEntry]
    topic: str = ""  # that its whole file is
    times: Path | None = None

    @property
    def called(self) -> str:
        """Its name in messages: its file, and its table where the file holds several."""
        name = entry_path(self.path)
        return f"{name} ({self.file.table})" if self.file.table else name

    @property
    def measures(self) -> bool:
        """Whether it has a measurement, or an estimate; not only a state, or what a sensor says of itself."""
        return any(channel.kind not in SAID for sensor in self.sensors for channel in sensor.channels)

    @property
    def stem(self) -> str:
        """What it is called: its table, or its file where that holds one."""
        return self.file.table or self.topic or stem_of(self.path)


@dataclass(frozen=True)
class Look:
    """What one file holds: tables that are sensors, reasons against the others, and notes."""

    guesses: list[Guess]
    errors: list[LogError]
    notes: list[str]


def look_at(file: Path, tell: Callable[[float], None], rate_hz: float | None = None) -> Look:
    """What one file's tables are; of an autopilot's, those that are sensors."""
    try:
        tables = read_beginning(file, tell) if is_long(file) else read_tables(file, Ask(tell=tell))
    except LogError as error:
        return Look([], [error], [])
    said = [said for one in tables.values() for said in (*(broken.sentence(file) for broken in one.damage), *one.notes)]
    stock = recognised(tables)
    if stock is not None:
        guesses, errors, remarks = _guess_stock(stock, tables)
        if any(one.measures for one in guesses):
            used = [one.file.table or "" for one in guesses]
            out = sorted(set(tables) - set(used))
            left = f" Left out as not sensors: {_some(out)}." if out else ""
            said += [f"{file.name}: a log of {stock.name}; sensors are in {', '.join(used)}.{left}"]
            said += [f"{file.name}: {remark}" for remark in remarks]
            return Look(guesses, errors, list(dict.fromkeys(said)))
    commands = [name for name in tables if _COMMAND.search(name)]
    if commands:
        said.append(f"{file.name}: left out, as they are commands: {', '.join(commands)}.")
    guesses, errors = _guess_tables(((name, one) for name, one in tables.items() if name not in commands), rate_hz)
    return Look(guesses, errors, list(dict.fromkeys(said)))


def look_at_topics(topics: Mapping[str, Path], others: list[str], tell: Callable[[float], None]) -> Look:
    """What the files of PX4's topics are, one each; `others`: what else lies there and is no sensor."""
    tables: dict[str, Source] = {}
    errors = []
    for topic, file in topics.items():
        try:
            tables[topic] = read_tables(file, Ask(tell=tell))[""]
        except LogError as error:
            errors.append(error)
    found, wrong, remarks = _guess_stock(PX4, tables)
    guesses = [replace(one, file=replace(one.file, table=None), topic=one.file.table or "") for one in found]
    errors += wrong
    used = [one.path.name for one in guesses]
    left = sorted([*others, *(tables[name].path.name for name in tables if tables[name].path.name not in used)])
    out = f" Left out as not sensors: {_some(left)}." if left else ""
    said = f"Topics of {PX4.name}, one file each; sensors are in {', '.join(used)}.{out}"
    return Look(guesses, errors, [said, *remarks])


def _some(names: list[str]) -> str:
    more = f" and {len(names) - NAMES_SHOWN} more" if len(names) > NAMES_SHOWN else ""
    return f"{', '.join(names[:NAMES_SHOWN])}{more}"


def _guess_stock(stock: Stock, tables: Tables) -> tuple[list[Guess], list[LogError], list[str]]:
    """The tables of an autopilot that have sensors, measurements first; why some are nothing; and remarks."""
    sensors, remarks = stock.sensors(tables)
    guesses, errors = _guess_tables((name, replace(tables[name], sensors=own)) for name, own in sensors.items())
    return guesses, errors, remarks


def _guess_tables(
    tables: Iterable[tuple[str, Source]], rate_hz: float | None = None
) -> tuple[list[Guess], list[LogError]]:
    """What the tables of one file are, and why some are nothing."""
    guesses, errors = [], []
    for name, source in tables:
        try:
            guesses.append(guess_table(source, name or None, rate_hz))
        except LogError as error:
            errors.append(LogError(f"{error} (table {name})") if name else error)
    return guesses, errors


def guess_table(source: Source, table: str | None, rate_hz: float | None = None) -> Guess:
    """The clock and the sensors in one table. `rate_hz`: its rows a second, if it has no clock."""
    path = source.path
    head = replace(source, frame=source.frame.head(_ROWS))
    timed = guess_time(head, rate_hz)
    clock = read_clock(head, timed)
    if timed.fine is not None:
        head = replace(head, frame=head.frame.drop(timed.fine))
    sensors, left_out = _sensors(head, timed.time, clock)
    tag = path.with_name(path.name + ".tag")
    has_tag = tag.is_file() and not clock.is_unix
    file = replace(
        timed, path=entry_path(path), tag=tag.name if has_tag else None, table=table, left_out=tuple(left_out)
    )
    return Guess(path, tuple(source.frame.columns), file, clock, sensors, times=source.times)


def _sensors(source: Source, time: str | None, clock: Clock) -> tuple[list[SensorEntry], list[tuple[str, str]]]:
    """The sensors that the format says or the columns look like, and the columns left out with the reason why."""
    if source.sensors:
        return list(source.sensors), []
    columns, left_out = measurements(source, time, clock)
    if not columns:
        raise LogError(
            f"{source.path}: no column beside the time looks like a measurement; describe the log in a vehicle.toml."
        )
    return guess_sensors(source, columns, clock), left_out
