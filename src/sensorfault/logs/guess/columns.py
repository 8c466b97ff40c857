"""Which columns measure something, and what."""

import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import polars as pl
from jaxtyping import Float

from sensorfault.logs.clock import Clock
from sensorfault.logs.guess.dotted import are_dotted, device_of, meaning_of
from sensorfault.logs.guess.words import Meaning, read_name
from sensorfault.logs.readers.source import Source
from sensorfault.logs.table import LogError
from sensorfault.logs.units import STANDARD_GRAVITY

_FEW = 16
_STEADY = 0.15  # relative spread below which three axes have a steady length


OTHER_TIME = "another time, or bookkeeping of it"
QUALITY = "quality or state, not a measurement of motion"
_OF_LENGTH_1, _NEARLY_ALL = 0.01, 0.99
_OF_A_DRIVE_DEG = 2.0  # so far a drive goes at most
_SENSORS = ("gyroscope", "gyro", "accelerometer", "acceleration", "magnetometer")  # as the files of phones are called
BEACON = frozenset({"range", "position", "depth"})  # what a beacon tells of itself


@dataclass(frozen=True)
class Column:
    """One column that measures something; `value` as in the file, NaN where there is none."""

    name: str
    meaning: Meaning
    value: Float[np.ndarray, " T"]
    device: str = ""  # the sensor, where the name of the column says it


def measurements(source: Source, time: str | None, clock: Clock) -> tuple[list[Column], list[tuple[str, str]]]:
    """Columns that measure something, and the others with the reason why not.

    Raises:
        LogError: a column of numbers has a cell that is none.
    """
    columns, left_out = [], []
    dotted = are_dotted(source.frame.columns)
    pose = pose_of(source, time) or fix_of(source, time)
    for name in source.frame.columns:
        if name == time:
            continue
        device = device_of(name) if dotted else ""
        own = source.units.get(name, "")
        meaning = meaning_of(name) if device else read_name(name, own, source.frame.columns)
        meaning = pose.get(name) or _by_file(meaning, source) or meaning
        if meaning.kind == "time":
            left_out.append((name, OTHER_TIME))
        elif meaning.kind == "quality":
            left_out.append((name, QUALITY))
        else:
            try:
                value = source.column(name).cast(pl.Float64).to_numpy()[clock.rows]
            except LogError:
                numbers = source.frame[name].cast(pl.Float64, strict=False).is_not_null().mean()
                if numbers is not None and float(numbers) > 0.5:  # type: ignore[arg-type]
                    raise  # a measurement with a cell that is none, not a column of words
                left_out.append((name, "holds text"))
                continue
            column = Column(name, meaning, np.where(np.isinf(value), np.nan, value), device)
            reason = _no_measurement(column)
            if reason:
                left_out.append((name, reason))
            else:
                columns.append(column)
    headerless = bool(columns) and not pose and all(re.fullmatch(r"c\d+", column.name) for column in columns)
    return _by_value(columns) if headerless else columns, left_out


def _by_file(meaning: Meaning, source: Source) -> Meaning | None:
    """What a bare x, y or z is in a file or table that is called after its sensor; None if that says nothing."""
    if meaning.kind != "local_position" or meaning.stem:
        return None
    for called in (source.table or "", source.path.stem):
        sensor = next((word for word in _SENSORS if word in called.lower().replace("_", "")), None)
        if sensor is not None:
            found = read_name(f"{sensor}_{meaning.axis}", meaning.unit)
            return replace(found, stem="") if found.axis == meaning.axis else None
    return None


def pose_of(source: Source, time: str | None) -> dict[str, Meaning]:
    """The columns of a table without names that are a position and a quaternion, of length 1: a TUM trajectory."""
    names = [name for name in source.frame.columns if name != time]
    if len(names) != 7 or not all(re.fullmatch(r"c\d+", name) for name in names):
        return {}
    try:
        value = np.column_stack([source.column(name).cast(pl.Float64).to_numpy() for name in names[3:]])
    except LogError:
        return {}
    length = np.linalg.norm(value, axis=1)
    if not (np.abs(length[np.isfinite(length)] - 1) < _OF_LENGTH_1).mean() > _NEARLY_ALL:
        return {}
    kinds = [("local_position", axis) for axis in "xyz"] + [("quaternion", axis) for axis in "xyzw"]
    return {name: Meaning(kind, axis, "", "") for name, (kind, axis) in zip(names, kinds, strict=True)}


def fix_of(source: Source, time: str | None) -> dict[str, Meaning]:
    """Two neighbours without names in a table called after a receiver that are a latitude and a longitude."""
    names = [name for name in source.frame.columns if name != time]
    called = re.search(r"(^|[^a-z])(gps|gnss)([^a-z]|$)", f"{source.table or ''} {source.path.stem}", re.IGNORECASE)
    if called is None or not all(re.fullmatch(r"c\d+", name) for name in names):
        return {}
    for one, other in pairwise(names):
        cells = [source.frame[name].cast(pl.Float64, strict=False).drop_nulls() for name in (one, other)]
        if all(
            len(cell) > 1 and most >= cell.abs().max() > 0 and cell.max() - cell.min() < _OF_A_DRIVE_DEG  # type: ignore[operator]
            and not (cell == cell.round(3)).all()
            for cell, most in zip(cells, (90.0, 180.0), strict=True)
        ):  # fmt: skip
            return {name: Meaning("position", axis, "", "") for name, axis in ((one, "latitude"), (other, "longitude"))}
    return {}


def beacons_of(meanings: Iterable[Meaning]) -> set[str]:
    """Stems of beacons that give their range and position: `leader1_range`, `leader1_latitude`."""
    kinds: dict[str, set[str]] = {}
    for meaning in meanings:
        kinds.setdefault(meaning.stem, set()).add(meaning.kind)
    return {stem for stem, found in kinds.items() if stem and {"range", "position"} <= found}


def _no_measurement(column: Column) -> str:
    """Why a column is not a measurement; one whose name says that it is a sensor's may be frozen for the whole log."""
    known = column.value[np.isfinite(column.value)]
    if not len(known):
        return "holds no value at all"
    if len(known) == 1:
        return "holds one value"
    if (known == known[0]).all() and not column.meaning.kind:
        return "constant"
    if column.meaning.kind == "temperature":
        return "a temperature, not a measurement of motion"
    if not column.meaning.kind and (known == np.round(known)).all():
        if len(np.unique(known)) <= _FEW:
            return "few whole numbers: a state or a counter"
        if (np.diff(known) >= 0).all():
            return "only increases: a counter"
    return ""


def _by_value(columns: list[Column]) -> list[Column]:
    """Columns without names: three neighbours whose length is gravity are an accelerometer, the next three a gyro."""
    left, named, gyro_due = list(columns), [], False
    while left:
        triple = left[:3]
        if len(triple) == 3 and _is_gravity(triple):
            kind, gyro_due = "accelerometer", True
        elif len(triple) == 3 and (gyro_due or (len(left) >= 6 and _is_gravity(left[3:6]))):
            kind, gyro_due = "gyro", False
        else:
            named.append(left.pop(0))
            continue
        named += [replace(c, meaning=Meaning(kind, axis, "", "")) for c, axis in zip(triple, "xyz", strict=True)]
        left = left[3:]
    return named


def _is_gravity(triple: list[Column]) -> bool:
    """Whether the usual length of three columns is 1 g, 9.8 m/s^2 or 1000 mg, and steady."""
    length = np.linalg.norm(np.column_stack([column.value for column in triple]), axis=1)
    middle = float(np.nanmedian(length))
    steady = float(np.nanmedian(np.abs(length - middle))) < _STEADY * middle
    return steady and any(0.8 < middle / gravity < 1.25 for gravity in (1.0, STANDARD_GRAVITY, 1000.0))
