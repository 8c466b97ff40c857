"""What describes the columns of a log: a vehicle.toml, what a model knows, or else a guess."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

from sensorfault.logs.agreement import conflict
from sensorfault.logs.guess import guess
from sensorfault.logs.place import Found, Where, called_after, find_vehicle, named_after, pair_files
from sensorfault.logs.readers.beginning import is_long, read_beginning
from sensorfault.logs.readers.formats import read_tables
from sensorfault.logs.readers.source import Ask, Tables
from sensorfault.logs.table import SAID, LogError
from sensorfault.logs.vehicle import VehicleFile, with_rate

GUESSED = "No vehicle.toml: sensors, units and held values are guesses; `sensorfault init` writes them down to check."

Tell = Callable[[float], None]


@dataclass(frozen=True)
class Description:
    """What the columns are. `notes`: where that is from. `guessed`: it is a guess.

    `silent`: files and tables that the log does not have; their sensors have no values. `tables`: what was read of the
    log to find out.
    """

    vehicle: VehicleFile
    notes: tuple[str, ...] = ()
    guessed: bool = False
    silent: frozenset[str] = frozenset()
    tables: dict[Path, Tables] = field(default_factory=dict)


def describe(
    path: Where,
    vehicle: str | Path | VehicleFile | None,
    model: VehicleFile | None,
    tell: Tell,
    rate_hz: float | None = None,
) -> Description:
    """The description of a log's columns. `rate_hz`: rows a second of its files without a clock.

    Raises:
        LogError: as `_describe`, or a rate is given and no file needs one.
    """
    found = _describe(path, vehicle, model, tell, rate_hz)
    return found if rate_hz is None else replace(found, vehicle=with_rate(found.vehicle, rate_hz))


def _describe(
    path: Where,
    vehicle: str | Path | VehicleFile | None,
    model: VehicleFile | None,
    tell: Tell,
    rate_hz: float | None,
) -> Description:
    """The same as it is found.

    A given vehicle file, or one beside the log that names it, is taken. One beside it that was written for another log
    is taken if the log has its columns. What a model knows is not guessed again.

    Raises:
        LogError: two descriptions disagree; or the log has some of the model's columns and not the others.
    """
    found = find_vehicle(path, vehicle)
    if found is not None and found.sure and model is None:
        return Description(called_after(found.vehicle, path))
    if found is None and model is None:
        return _guessed(path, tell, rate_hz)
    looked = _Look(path, tell)
    notes: list[str] = []
    if found is not None and not found.sure and (lacks := looked.lacks(found.vehicle)):
        notes.append(f"{found.vehicle.where} is of another log and was not used: {lacks[0]}.")
        found = None
    if model is not None:
        if found is not None and (clash := conflict(found.vehicle, model)):
            raise LogError(f"{clash}; correct one of them, or fit the model again.")
        if found is None or not _covers(found.vehicle, model):
            known = _known(looked, model, found)
            if known is not None:
                return replace(known, notes=(*notes, *known.notes))
    if found is not None:
        return Description(called_after(found.vehicle, path), tuple(notes), tables=looked.tables)
    guessed = _guessed(path, tell, rate_hz)
    return replace(guessed, notes=(*notes, *guessed.notes))


def _guessed(path: Where, tell: Tell, rate_hz: float | None) -> Description:
    vehicle = guess(path, tell, rate_hz)
    return Description(vehicle, (GUESSED, *vehicle.notes), guessed=True)


def _known(looked: "_Look", model: VehicleFile, found: Found | None) -> Description | None:
    """What the model knows, if the log is of its format.

    Raises:
        LogError: the log has some of the columns, but not all.
    """
    model = looked.without_asides(model)
    silent, columns, there = looked.compare(model)
    if not there:
        return None
    if columns:
        raise LogError(f"{columns[0]}, which {model.where} knows; give a vehicle.toml that says what its columns are.")
    own = replace(named_after(model, looked.path), epoch_s=None, zero_s=None)
    if found is not None:
        own = replace(own, epoch_s=found.vehicle.epoch_s, zero_s=found.vehicle.zero_s)
    files = {file.name: file for file in own.files}
    guessed = ", by a guess; `sensorfault init` writes one down to check" if model.guessed else ""
    notes = [f"Columns are read as {model.where} knows them{guessed}."]
    for name in sorted(silent):
        sensors = ", ".join(sensor.name for sensor in own.sensors if sensor.file == name)
        notes.append(f"There is no {files[name].table or files[name].path} in this log, so {sensors} has no values.")
    return Description(own, tuple(notes), silent=frozenset(silent), tables=looked.tables)


def _covers(vehicle: VehicleFile, model: VehicleFile) -> bool:
    """Whether all channels of the model are described."""
    paths = [{f"{s.name}.{c.name}" for s in one.sensors for c in s.channels} for one in (vehicle, model)]
    return paths[1] <= paths[0]


class _Look:
    """The tables of a log, of a long one its beginning; read when they are asked for, once."""

    def __init__(self, path: Where, tell: Tell) -> None:
        self.path, self._tell = path, tell
        self.tables: dict[Path, Tables] = {}

    def lacks(self, vehicle: VehicleFile) -> list[str]:
        """What the log lacks of what is described, in clauses."""
        try:
            silent, columns, _ = self.compare(vehicle)
        except LogError as error:
            return [str(error).rstrip(".")]
        return [*columns, *(f"there is no table of its [file.{name}]" for name in sorted(silent))]

    def compare(self, vehicle: VehicleFile) -> tuple[set[str], list[str], bool]:
        """Described files that are not there; columns that are not, in clauses; whether any column is."""
        silent: set[str] = set()
        lacking: list[str] = []
        there = False
        for entry, file in pair_files(vehicle, self.path):
            tables = self._read(file)
            source = tables.get(entry.table or "")
            if source is None and entry.name in vehicle.asides:
                continue
            if source is None:
                silent |= set() if is_long(file) else {entry.name}  # it may begin later in a long one
                continue
            mine = [sensor for sensor in vehicle.sensors if sensor.file == entry.name]
            named = [channel.column for sensor in mine for channel in sensor.channels]
            named += [name for name in (entry.time, entry.fine, *(sensor.epoch for sensor in mine)) if name is not None]
            absent = [name for name in dict.fromkeys(named) if name not in source.frame.columns]
            lacking += [f"{source.path.name} has no column '{name}'" for name in absent]
            there |= any(channel.column in source.frame.columns for sensor in mine for channel in sensor.channels)
        return silent, lacking, there

    def without_asides(self, vehicle: VehicleFile) -> VehicleFile:
        """The description without quality and context that the log does not have: no sensor needs them."""
        gone: set[tuple[str, str]] = set()
        for entry, file in pair_files(vehicle, self.path):
            source = self._read(file).get(entry.table or "")
            columns = source.frame.columns if source is not None else []
            gone |= {
                (sensor.name, channel.name)
                for sensor in vehicle.sensors
                for channel in sensor.channels
                if sensor.file == entry.name and channel.kind in SAID and channel.column not in columns
            }
        sensors = [
            replace(sensor, channels=tuple(c for c in sensor.channels if (sensor.name, c.name) not in gone))
            for sensor in vehicle.sensors
        ]
        return replace(vehicle, sensors=tuple(sensor for sensor in sensors if sensor.channels))

    def _read(self, file: Path) -> Tables:
        if file not in self.tables:
            tell = self._tell
            self.tables[file] = read_beginning(file, tell) if is_long(file) else read_tables(file, Ask(tell=tell))
        return self.tables[file]
