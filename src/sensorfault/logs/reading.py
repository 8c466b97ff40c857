"""The work of `read`: a log's files, its vehicle file, one clock."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from sensorfault.logs.clock import is_unix
from sensorfault.logs.describing import Description, describe
from sensorfault.logs.entries import FileEntry
from sensorfault.logs.guess.vehicle import guess_source
from sensorfault.logs.jumps import distinct
from sensorfault.logs.one_clock import OneClock, put_on_one_clock
from sensorfault.logs.pauses import pauses_said
from sensorfault.logs.place import Where, pair_files
from sensorfault.logs.readers.beginning import is_long
from sensorfault.logs.readers.formats import read_tables, take_table
from sensorfault.logs.readers.source import Ask, Source, Tables
from sensorfault.logs.resample import Resample
from sensorfault.logs.stream import Stream, channel_of, read_stream
from sensorfault.logs.table import Log, LogError, Sensor
from sensorfault.logs.vehicle import VehicleFile, with_rate

GUESSED_TABLE = "No vehicle file: sensors, units and held values are guesses; give vehicle= to say what they are."


@np.errstate(over="ignore", invalid="ignore")  # of numbers as damage makes them
def read_files(
    path: Where,
    vehicle: str | Path | VehicleFile | None,
    resample: Resample,
    tell: Callable[[float], None],
    model: VehicleFile | None = None,
    rate_hz: float | None = None,
) -> Log:
    """What `read` says."""
    described = describe(path, vehicle, model, tell, rate_hz)
    known = described.vehicle
    used = {sensor.file for sensor in known.sensors} - described.silent
    pairs = [(entry, file) for entry, file in pair_files(known, path) if entry.name in used]
    sources = _sources(pairs, described, tell)
    streams, present, without = _streams(known, [entry for entry, _ in pairs], sources)
    clock = put_on_one_clock(streams, resample)
    damage = tuple(dict.fromkeys(one.sentence(source.path) for source in sources.values() for one in source.damage))
    said = tuple(note for stream in streams for note in stream.notes)
    log = log_of(present, streams, clock, damage)
    silent = replace(
        known, sensors=tuple(s for s in known.sensors if s in present.sensors or s.file in described.silent)
    )
    return with_notes(widened(log, silent), (*damage, *described.notes), (*without, *said, *clock.notes))


def _streams(
    known: VehicleFile, entries: list[FileEntry], sources: Mapping[str, Source]
) -> tuple[list[Stream], VehicleFile, list[str]]:
    """What each file says, what it is, and notes. What is beside the measurements and cannot be read is left out."""
    streams, there, notes = [], set(), []
    for entry in entries:
        mine = tuple(sensor for sensor in known.sensors if sensor.file == entry.name)
        try:
            if entry.name in sources:
                streams.append(read_stream(sources[entry.name], entry, mine))
                there.add(entry.name)
        except LogError as error:
            if entry.name not in known.asides:
                raise
            notes.append(f"Left out: {error}")
    sensors = tuple(sensor for sensor in known.sensors if sensor.file in there)
    return streams, known if sensors == known.sensors else replace(known, sensors=sensors), notes


def read_table(
    source: Source, vehicle: str | Path | VehicleFile | None, resample: Resample, rate_hz: float | None = None
) -> Log:
    """A log of one table that is in memory."""
    described = vehicle if isinstance(vehicle, VehicleFile) or vehicle is None else VehicleFile.read(vehicle)
    known = described or guess_source(source, rate_hz)
    known = known if rate_hz is None else with_rate(known, rate_hz)
    if len(known.files) > 1:
        raise LogError(f"{known.name}: it describes {len(known.files)} files, but a table is one; describe one file.")
    entry = known.files[0]
    if described and entry.time is not None:
        source = replace(source, unit=source.unit if source.time == entry.time else None)
    stream = read_stream(source, entry, known.sensors)
    clock = put_on_one_clock([stream], resample)
    notes = () if described else (GUESSED_TABLE, *known.notes)
    return with_notes(log_of(known, [stream], clock, ()), notes, (*stream.notes, *clock.notes))


def with_notes(log: Log, first: tuple[str, ...], notes: tuple[str, ...]) -> Log:
    """The log with these notes, each once; after the first ones, one on its pauses."""
    return replace(log, notes=tuple(dict.fromkeys((*first, *pauses_said(log.pauses), *notes))))


def _sources(
    pairs: Sequence[tuple[FileEntry, Path]], described: Description, tell: Callable[[float], None]
) -> dict[str, Source]:
    """Each entry's table; each file is read once, all of its tables where `guess` has just asked for them."""
    wanted: dict[Path, list[FileEntry]] = {}
    for entry, file in pairs:
        wanted.setdefault(file, []).append(entry)
    found: dict[str, Source] = {}
    for file, entries in wanted.items():
        names = frozenset(entry.table for entry in entries if entry.table is not None)
        every = described.guessed or any(entry.table is None for entry in entries)
        read: Mapping[Path, Tables] = {} if is_long(file) else described.tables
        tables = read.get(file) or read_tables(file, Ask(None if every else names, tell))
        asides = described.vehicle.asides
        there = [entry for entry in entries if entry.name not in asides or entry.table in (None, *tables)]
        found |= {entry.name: take_table(file, tables, entry.table) for entry in there}
    return found


def log_of(
    vehicle: VehicleFile, streams: list[Stream], clock: OneClock, damage: tuple[str, ...], notes: tuple[str, ...] = ()
) -> Log:
    """The log of these streams, its channels in the order of the vehicle file."""
    start = clock.zero_s + float(clock.time[0])
    zero = start if vehicle.zero_s is None else vehicle.zero_s
    channels = [channel for stream in streams for channel in stream.channels]
    sensors = {sensor.name: sensor for stream in streams for sensor in stream.sensors}
    at = {channel.path: i for i, channel in enumerate(channels)}
    order = [at[f"{sensor.name}.{channel.name}"] for sensor in vehicle.sensors for channel in sensor.channels]
    in_order = order == list(range(len(order)))  # spares a copy of long logs
    jumps = distinct(replace(j, time_s=j.time_s + one.zero_s - zero) for one in streams for j in one.jumps)
    epoch = vehicle.epoch_s if vehicle.epoch_s is not None else (zero if is_unix(zero) else None)
    return Log(
        time=clock.time - clock.time[0] + (start - zero),
        value=clock.value if in_order else np.ascontiguousarray(clock.value[:, order]),
        fresh=clock.fresh if in_order else np.ascontiguousarray(clock.fresh[:, order]),
        channels=tuple(channels[i] for i in order),
        sensors=tuple(sensors[sensor.name] for sensor in vehicle.sensors),
        name=vehicle.name,
        notes=notes,
        damage=damage,
        epoch_s=epoch,
        wheelbase_m=vehicle.wheelbase_m,
        steering_ratio=vehicle.steering_ratio,
        description=vehicle,
        jumps=jumps,
    )


def widened(log: Log, known: VehicleFile) -> Log:
    """The log with all channels of the vehicle; missing ones have no values."""
    channels = tuple(channel_of(c, s) for s in known.sensors for c in s.channels)
    if channels == log.channels:
        return log
    value, fresh = np.full((len(log), len(channels)), np.nan), np.zeros((len(log), len(channels)), bool)
    at = [channels.index(channel) for channel in log.channels]
    value[:, at], fresh[:, at] = log.value, log.fresh
    have = {sensor.name: sensor for sensor in log.sensors}
    sensors = tuple(have.get(s.name, Sensor(s.name, s.period_s or float("nan"), s.held)) for s in known.sensors)
    return replace(log, value=value, fresh=fresh, channels=channels, sensors=sensors, description=known)
