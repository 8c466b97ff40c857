"""Columns that measure something -> sensors with channels, units and the way the file holds them."""

import re
from collections.abc import Sequence

import numpy as np
import polars as pl

from sensorfault.logs import guess_units as units
from sensorfault.logs.clock import Clock
from sensorfault.logs.entries import ChannelEntry, SensorEntry
from sensorfault.logs.guess_columns import Column
from sensorfault.logs.held import changes, looks_held, repeats, share_repeated
from sensorfault.logs.source import Source
from sensorfault.logs.units import to_si
from sensorfault.logs.words import read_name

_UNWATCHED = {
    "position": "a position is not stationary: only its silence is noticed",
    "local_position": "a position is not stationary: only its silence is noticed",
    "height": "a height is not stationary: only its silence is noticed",
    "depth": "a depth is not stationary: only its silence is noticed",
    "heading": "an angle that wraps: only its silence is noticed",
    "quaternion": "a quaternion is not stationary: only its silence is noticed",
}
_USUAL_UNIT = {
    "magnetometer": "uT", "velocity": "m/s", "airspeed": "m/s", "local_position": "m", "range": "m", "depth": "m",
    "barometer": "hPa",
}  # fmt: skip
_IN_GNSS = {
    "speed": "gnss",
    "velocity": "gnss",
    "heading": "gnss_course",
    "position": "gnss_position",
    "height": "gnss_position",
}
_NO_VALUE = -1.0  # a usual mark for "no value" among lengths and the like
_WANDERS = 3.0  # halves whose levels differ by more than so many spreads are of something that wanders


def guess_sensors(source: Source, columns: Sequence[Column], clock: Clock) -> list[SensorEntry]:
    """The sensors of one file."""
    has_position = any(column.meaning.kind == "position" for column in columns)
    place = _place_rad(columns)
    groups: dict[str, list[Column]] = {}
    for column in columns:
        kind = _kind(column)
        groups.setdefault(_sensor_name(column, kind, columns, has_position), []).append(column)
    return [_sensor(name, group, source, clock, place) for name, group in groups.items()]


def _kind(column: Column) -> str:
    """The kind its name says; roll and pitch that wrap are headings."""
    kind = column.meaning.kind
    if kind == "attitude" and units.wraps(column.value, column.meaning.unit or units.angle_unit(column.value)[0]):
        return "heading"
    return kind


def _sensor_name(column: Column, kind: str, columns: Sequence[Column], has_position: bool) -> str:
    meaning = column.meaning
    if not kind:
        return re.sub(r"_?\d+$", "", meaning.axis) or meaning.axis
    alike = {other.meaning.stem for other in columns if other.meaning.kind == meaning.kind}
    course = kind != "heading" or meaning.axis in ("course", "heading", "track")
    if has_position and kind in _IN_GNSS and course and len(alike) == 1:
        return _IN_GNSS[kind]
    if meaning.stem and (len(alike) > 1 or kind == "velocity"):
        return meaning.stem if kind == "velocity" else f"{meaning.stem}_{kind}"
    return kind


def _sensor(name: str, group: list[Column], source: Source, clock: Clock, place_rad: np.ndarray | None) -> SensorEntry:
    kind = _kind(group[0])
    value = np.column_stack([column.value for column in group])
    channels, seen = [], set()
    for i, column in enumerate(group):
        unit, why = _unit(column, value, clock, place_rad)
        channel = column.meaning.axis if column.meaning.axis not in seen else column.name
        channel = re.sub(r"\W+", "_", channel)
        seen.add(channel)
        channels.append(ChannelEntry(channel, column.name, unit, _missing_mark(value[:, i], kind), why=why))
    held = looks_held(value) or all(looks_held(channel[:, None]) for channel in value.T)
    epoch = _epoch(source, value, clock) if held else None
    reasons = [
        f"{share_repeated(value):.0%} of the rows repeat" if held else "",
        f"{epoch} changes with it" if epoch else "",
    ]
    watch = kind not in _UNWATCHED and not (kind == "" and _wanders(value))
    reasons.append("" if watch else _UNWATCHED.get(kind, "its level wanders: only its silence is noticed"))
    return SensorEntry(
        name,
        tuple(channels),
        held=held,
        epoch=epoch,
        watch=watch,
        why="; ".join(reason for reason in reasons if reason),
    )


def _unit(column: Column, group: np.ndarray, clock: Clock, place_rad: np.ndarray | None) -> tuple[str, str]:
    """Unit and reason."""
    meaning, value, kind = column.meaning, column.value, _kind(column)
    if meaning.unit:
        return meaning.unit, "unit in its name"
    match kind:
        case "accelerometer":
            return units.acceleration_unit(group)
        case "gyro":
            return units.rate_unit(group)
        case "attitude" | "heading":
            return units.angle_unit(value)
        case "position":
            return units.position_unit(value)
        case "height":
            return units.height_unit(value)
        case "speed":
            return units.speed_unit(value, clock.time, place_rad)
    unit = _USUAL_UNIT.get(kind, "")
    return unit, f"the usual unit of a {kind}" if unit else ""


def _place_rad(columns: Sequence[Column]) -> np.ndarray | None:
    """Latitude and longitude [rad], if the file has one of each."""
    found = {}
    for column in columns:
        if column.meaning.kind == "position":
            unit = column.meaning.unit or units.position_unit(column.value)[0]
            found[column.meaning.axis] = to_si(column.value, unit)
    if "latitude" not in found or "longitude" not in found:
        return None
    return np.column_stack([found["latitude"], found["longitude"]])


def _missing_mark(value: np.ndarray, kind: str) -> float | None:
    """-1 where everything else is positive: a length that was not measured."""
    marked = value == _NO_VALUE
    others = value[~marked & np.isfinite(value)]
    if kind == "range" and marked.any() and len(others) and (others >= 0).all():
        return _NO_VALUE
    return None


def _epoch(source: Source, value: np.ndarray, clock: Clock) -> str | None:
    """A time or sequence column that changes as often as the held sensor's liveliest channel, or somewhat oftener."""
    moved = max(int((~repeats(channel[:, None])).sum()) for channel in value.T)
    best: tuple[float, str] | None = None
    for name in source.frame.columns:
        column = source.frame[name]
        if read_name(name).kind != "time" or not column.dtype.is_numeric():
            continue
        reading = column.cast(pl.Float64).fill_null(np.nan).to_numpy()[clock.rows]
        ratio = float(changes(reading).sum()) / max(moved, 1)
        rising = np.nanmin(np.diff(reading), initial=0.0) >= 0
        if rising and 0.95 < ratio < 2.0 and (best is None or ratio < best[0]) and not _of_the_rows(reading):
            best = ratio, name
    return best[1] if best else None


def _of_the_rows(reading: np.ndarray) -> bool:
    """Whether a column changes in nearly every row: a clock of the rows, not of the measurements."""
    return float(changes(reading).mean()) > 0.9


def _wanders(value: np.ndarray) -> bool:
    """Whether any channel's level differs between the halves by more than its spread within them."""
    return any(_steps(channel[np.isfinite(channel)]) for channel in value.T)


def _steps(channel: np.ndarray) -> bool:
    first, second = np.array_split(channel, 2)
    if not len(first) or not len(second):
        return False
    spread = np.sqrt((first.var() + second.var()) / 2)
    return bool(abs(first.mean() - second.mean()) > _WANDERS * spread)
