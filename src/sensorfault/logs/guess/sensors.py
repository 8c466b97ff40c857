"""Columns that measure something -> sensors with channels, units and the way the file holds them."""

import re
from collections.abc import Sequence

import numpy as np

from sensorfault.logs.clock import Clock
from sensorfault.logs.entries import ChannelEntry, SensorEntry
from sensorfault.logs.guess import units
from sensorfault.logs.guess.columns import BEACON, Column, beacons_of
from sensorfault.logs.guess.devices import Device, find_devices
from sensorfault.logs.guess.words import RECEIVERS
from sensorfault.logs.held import any_of
from sensorfault.logs.readers.source import Source
from sensorfault.logs.units import to_si

_UNWATCHED = {
    "position": "a position is not stationary: only dropouts are detected",
    "local_position": "a position is not stationary: only dropouts are detected",
    "height": "a height is not stationary: only dropouts are detected",
    "depth": "a depth is not stationary: only dropouts are detected",
    "heading": "an angle that wraps: only dropouts are detected",
    "satellite": "raw data of a satellite: judged as an epoch, not by themselves",
    "quaternion": "a quaternion is not stationary: only dropouts are detected",
}
_USUAL_UNIT = {
    "magnetometer": "uT", "velocity": "m/s", "airspeed": "m/s", "local_position": "m", "range": "m", "depth": "m",
    "barometer": "hPa",
}  # fmt: skip
_FROM_GNSS = ("speed", "velocity", "position", "height")  # and a heading that is a course
_ANGLES = ("attitude", "heading")  # of one device they have one unit
_COURSES = ("course", "heading", "track")
_ROWS_OF_A_UNIT = 50_000  # as many show the size of a sensor's values
_NO_VALUE = -1.0  # a usual mark for "no value" among lengths and the like
_WANDERS = 3.0  # halves whose levels differ by more than so many spreads are of something that wanders


def guess_sensors(source: Source, columns: Sequence[Column], clock: Clock) -> list[SensorEntry]:
    """The sensors of one file."""
    beacons = beacons_of(column.meaning for column in columns)
    theirs = {column.name for column in columns if column.meaning.stem in beacons and column.meaning.kind in BEACON}
    own = [column for column in columns if column.name not in theirs]
    has_position = any(column.meaning.kind == "position" for column in own)
    place = _place_rad(own)
    parts: dict[str, list[Column]] = {}
    for column in columns:
        name = column.device or (column.meaning.stem if column.name in theirs else _part(column, own, has_position))
        parts.setdefault(name, []).append(column)
    return [_sensor(device, clock, place) for device in find_devices(parts, source, clock)]


def _kind(column: Column) -> str:
    """The kind its name says; roll and pitch that wrap are headings."""
    kind = column.meaning.kind
    if kind == "attitude" and units.wraps(column.value, column.meaning.unit or units.angle_unit(column.value)[0]):
        return "heading"
    return kind


def _part(column: Column, columns: Sequence[Column], has_position: bool) -> str:
    """What a column is a part of; parts that come together become one sensor."""
    meaning, kind = column.meaning, _kind(column)
    if not kind:
        return re.sub(r"_?\d+$", "", meaning.axis) or meaning.axis
    alike = {other.meaning.stem for other in columns if other.meaning.kind == meaning.kind}
    course = kind == "heading" and meaning.axis in _COURSES and "compass" not in meaning.stem
    received = has_position or RECEIVERS.search(meaning.stem)
    if received and (course or kind in _FROM_GNSS) and len(alike) == 1:
        return "gnss_course" if course else f"gnss_{kind}"
    if meaning.stem and (len(alike) > 1 or kind == "velocity"):
        return meaning.stem if kind == "velocity" else f"{meaning.stem}_{kind}"
    return kind


def _sensor(device: Device, clock: Clock, place_rad: np.ndarray | None) -> SensorEntry:
    group = _some(np.column_stack([column.value for column in device.columns]))
    angles = np.column_stack([column.value for column in device.columns if _kind(column) in _ANGLES] or [group])
    channels, seen = [], set()
    for column in device.columns:
        unit, why = _unit(column, angles if _kind(column) in _ANGLES else group, clock, place_rad)
        name = re.sub(r"\W+", "_", column.meaning.axis if column.meaning.axis not in seen else column.name)
        seen.add(name)
        blind = _blind(column)
        why = "; ".join(reason for reason in (why, blind) if reason)
        missing = _missing_mark(column.value, _kind(column))
        channels.append(ChannelEntry(name, column.name, unit, missing, watch=not blind, why=why))
    came = device.delivery
    reasons = [f"{came.old:.0%} of the rows repeat"] if came.held else []
    reasons += [f"{came.epoch} changes with it"] if came.epoch else []
    return SensorEntry(device.name, tuple(channels), held=came.held, epoch=came.epoch, why="; ".join(reasons))


def _some(group: np.ndarray) -> np.ndarray:
    """Rows with a value, not too many; at random, as each second row may be another device's."""
    rows = np.flatnonzero(any_of(np.isfinite(group)))
    if len(rows) <= _ROWS_OF_A_UNIT:
        return group
    some: np.ndarray = group[np.random.default_rng(0).choice(rows, _ROWS_OF_A_UNIT, replace=False)]
    return some


def _blind(column: Column) -> str:
    """Why the column's values cannot be judged; empty if they can."""
    kind = _kind(column)
    if kind == "barometer" and column.meaning.axis == "altitude":
        kind = "height"
    wanders = kind == "" and _wanders(column.value[np.isfinite(column.value)])
    return _UNWATCHED.get(kind, "its level drifts: only dropouts are detected" if wanders else "")


def _unit(column: Column, group: np.ndarray, clock: Clock, place_rad: np.ndarray | None) -> tuple[str, str]:
    """Unit, and how sure it is with the reason: "sure", "likely" or "a guess"."""
    meaning, value, kind = column.meaning, column.value, _kind(column)
    if meaning.unit:
        return meaning.unit, "sure: unit in its name or its format"
    match kind:
        case "accelerometer":
            return units.acceleration_unit(group)
        case "gyro":
            return units.rate_unit(group)
        case "attitude" | "heading" | "steering":
            return units.angle_unit(group.ravel())
        case "position":
            return units.position_unit(value)
        case "height":
            return units.height_unit(value)
        case "speed" | "wheels":
            return units.speed_unit(value, clock.time, place_rad)
    unit = _USUAL_UNIT.get(kind, "")
    return unit, f"a guess: the usual unit of a {kind}" if unit else ""


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


def _wanders(channel: np.ndarray) -> bool:
    """Whether its level differs between the halves by more than its spread within them."""
    first, second = np.array_split(channel, 2)
    if not len(first) or not len(second):
        return False
    spread = np.sqrt((first.var() + second.var()) / 2)
    return bool(abs(first.mean() - second.mean()) > _WANDERS * spread)
