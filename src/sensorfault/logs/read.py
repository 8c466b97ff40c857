"""Read a log: its files, its vehicle file, one clock."""

from pathlib import Path

import numpy as np

from sensorfault.logs.clock import is_unix
from sensorfault.logs.guess import guess
from sensorfault.logs.one_clock import OneClock, Resample, put_on_one_clock
from sensorfault.logs.place import Where, find_vehicle, pair_files
from sensorfault.logs.readers.formats import read_source
from sensorfault.logs.stream import Stream, read_stream
from sensorfault.logs.table import Log
from sensorfault.logs.vehicle import VehicleFile

GUESSED = "No vehicle.toml: sensors, units and held values are guesses; `sensorfault init` writes them down to check."


def read(path: Where, vehicle: str | Path | VehicleFile | None = None, resample: Resample = "hold") -> Log:
    """Read a log.

    Args:
        path: a file, a folder, or several files of one drive.
        vehicle: what the columns are: a vehicle.toml, or what was read from one. None: `NAME.vehicle.toml` or
            `vehicle.toml` beside the log; where there is none the columns are guessed, and a note says so.
        resample: how slower files come to the ticks of the fastest. "hold": a measurement is put on the first tick
            at or after its own time and the other ticks stay empty. "linear": drawn between measurements, which looks
            into the future and smooths faults over; for plots, and for papers that ask for it.

    Returns:
        The log in SI units on one clock.

    Raises:
        LogError: whatever keeps the log from being used, in one sentence.
    """
    described = find_vehicle(path, vehicle)
    known = described or guess(path)
    notes = () if described else (GUESSED, *known.notes)
    streams = []
    for entry, file in pair_files(known, path):
        sensors = tuple(sensor for sensor in known.sensors if sensor.file == entry.name)
        if sensors:
            streams.append(read_stream(read_source(file, entry.table), entry, sensors))
    clock = put_on_one_clock(streams, resample)
    said = tuple(note for stream in streams for note in stream.notes)
    return _log(known, streams, clock, (*notes, *said, *clock.notes))


def _log(vehicle: VehicleFile, streams: list[Stream], clock: OneClock, notes: tuple[str, ...]) -> Log:
    """The streams' channels in the order of the vehicle file."""
    start = clock.zero_s + float(clock.time[0])
    zero = start if vehicle.zero_s is None else vehicle.zero_s
    channels = [channel for stream in streams for channel in stream.channels]
    sensors = {sensor.name: sensor for stream in streams for sensor in stream.sensors}
    at = {channel.path: i for i, channel in enumerate(channels)}
    order = [at[f"{sensor.name}.{channel.name}"] for sensor in vehicle.sensors for channel in sensor.channels]
    in_order = order == list(range(len(order)))  # spares a copy of long logs
    epoch = vehicle.epoch_s if vehicle.epoch_s is not None else (zero if is_unix(zero) else None)
    return Log(
        time=clock.time - clock.time[0] + (start - zero),
        value=clock.value if in_order else np.ascontiguousarray(clock.value[:, order]),
        fresh=clock.fresh if in_order else np.ascontiguousarray(clock.fresh[:, order]),
        channels=tuple(channels[i] for i in order),
        sensors=tuple(sensors[sensor.name] for sensor in vehicle.sensors),
        name=vehicle.name,
        notes=notes,
        epoch_s=epoch,
        wheelbase_m=vehicle.wheelbase_m,
        steering_ratio=vehicle.steering_ratio,
    )
