"""Which columns measure something, and what."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
import polars as pl
from jaxtyping import Float

from sensorfault.logs.clock import Clock
from sensorfault.logs.guess.dotted import are_dotted, device_of, meaning_of
from sensorfault.logs.guess.nameless import by_gravity, is_nameless, placed
from sensorfault.logs.guess.words import Meaning, read_name
from sensorfault.logs.readers.source import Source
from sensorfault.logs.table import LogError

_FEW = 16


OTHER_TIME = "another time, or bookkeeping of it"
QUALITY = "quality or state, not a measurement of motion"
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
    places = placed(source, time)
    for name in source.frame.columns:
        if name == time:
            continue
        device = device_of(name) if dotted else ""
        own = source.units.get(name, "")
        meaning = meaning_of(name) if device else read_name(name, own, source.frame.columns)
        meaning = places.get(name) or _by_file(meaning, source) or meaning
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
    if not places and is_nameless([column.name for column in columns]):
        kinds = by_gravity(np.column_stack([column.value for column in columns]))
        columns = [
            replace(column, meaning=Meaning(kind, axis, "", "")) if kind else column
            for column, (kind, axis) in zip(columns, kinds, strict=True)
        ]
    return columns, left_out


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
