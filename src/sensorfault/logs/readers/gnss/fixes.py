"""A receiver's own fixes: place, velocity and course, as one sensor."""

import struct
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import polars as pl

from sensorfault.logs.entries import ChannelEntry, SensorEntry
from sensorfault.logs.readers.source import Source

_PVT = struct.Struct("<IHBBBBBBIiBBBBiiiiIIiiiii")
_VALID_TIME = 0b11  # date and time are known
_UNITS = {  # of the channels; those of False are not judged
    "latitude": ("deg", False),
    "longitude": ("deg", False),
    "altitude": ("m", False),
    "north": ("m/s", True),
    "east": ("m/s", True),
    "down": ("m/s", True),
    "speed": ("m/s", True),
    "course": ("deg", False),
}


def fixes(path: Path, solutions: list[bytes]) -> Source:
    """Messages NAV-PVT as a table on Unix time; without a fix there are no values. Altitude is above the ellipsoid."""
    rows: list[list[float]] = []
    for payload in solutions:
        result = _PVT.unpack_from(payload)
        try:
            year, month, day, hour, minute = result[1:6]
            time = datetime(year, month, day, hour, minute, tzinfo=UTC).timestamp() + result[6] + 1e-9 * result[9]
        except ValueError:
            time = float("nan")
        if result[7] & _VALID_TIME != _VALID_TIME:
            time = float("nan")
        lon, lat, height, north, east, down, speed, course = (result[i] for i in (14, 15, 16, 20, 21, 22, 23, 24))
        place = [1e-7 * lat, 1e-7 * lon, *(1e-3 * mm for mm in (height, north, east, down, speed)), 1e-5 * course]
        rows.append([time, *(place if result[11] & 1 else [float("nan")] * len(place))])
    return gnss_table(path, dict(zip(("time", *_UNITS), np.array(rows).T, strict=True)))


def gnss_table(path: Path, columns: dict[str, np.ndarray]) -> Source:
    """Columns by their names as in _UNITS, and `time`, as a receiver's table; one without any value is left out."""
    held = {name: column for name, column in columns.items() if name == "time" or np.isfinite(column).any()}
    channels = tuple(
        ChannelEntry(name, name, unit, watch=watch) for name, (unit, watch) in _UNITS.items() if name in held
    )
    frame = pl.DataFrame({name: np.ascontiguousarray(column) for name, column in held.items()})
    return Source(path, frame, "time", "s", sensors=(SensorEntry("gnss", channels),) if channels else ())
