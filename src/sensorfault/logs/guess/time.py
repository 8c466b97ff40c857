"""Which column is the time, and in what unit."""

import re

import numpy as np
import polars as pl

from sensorfault.logs.clock import is_unix
from sensorfault.logs.guess.words import read_name
from sensorfault.logs.readers.source import Source
from sensorfault.logs.table import LogError

_RISING = 0.8  # share of the steps that must be forward
_SPAN = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
_USUAL_STEP_S = 0.05
_NAMED_UNITS = {"s": "s", "sec": "s", "ms": "ms", "us": "us", "ns": "ns"}
_UNIT_WORDS = (("ms", r"millis|msec|_ms$"), ("us", r"micros|usec|_us$"), ("ns", r"nanos|nsec|_ns$"))


def guess_time(source: Source) -> tuple[str, str, str]:
    """Time column, its unit and the reason.

    Raises:
        LogError: no column increases like a time.
    """
    if source.time is not None:
        why = f"{source.path.suffix} files have a time column"
        return source.time, source.unit or _unix_unit(source.frame[source.time]) or "s", why
    ranked = []
    for i, name in enumerate(source.frame.columns):
        column = source.frame[name]
        if column.dtype == pl.String and read_name(name).kind == "time" and _mostly_numbers(column):
            source.column(name)  # says which cell is none
        if column.dtype == pl.String or column.dtype.is_temporal():
            share, unit = _calendar(column)
        elif column.dtype.is_numeric():
            share, unit = _rising(column), ""
        else:
            continue
        if share < _RISING:
            continue
        named = read_name(name).kind == "time"
        unit = unit or _unit(name, column)
        ranked.append((named, _is_unix(column, unit), round(share, 2), -i, name, unit))
    if not ranked:
        raise LogError(
            f"{source.path}: there is no time column: no column increases from row to row; add one, or name it in "
            "vehicle.toml if the rows are out of order."
        )
    named, unix, _, _, name, unit = max(ranked)
    why = "by its name" if named else "increases from row to row"
    return name, unit, f"{why}; unit {'as Unix time' if unix else 'by name and usual interval'}"


def _mostly_numbers(column: pl.Series) -> bool:
    return column.str.strip_chars().cast(pl.Float64, strict=False).null_count() < len(column) / 2


def _rising(column: pl.Series) -> float:
    step = np.diff(column.cast(pl.Float64).drop_nulls().to_numpy())
    return float(np.mean(step > 0)) if len(step) else 0.0


def _calendar(column: pl.Series) -> tuple[float, str]:
    """Share of steps forward if the cells are dates and times."""
    stamp = column
    if column.dtype == pl.String:
        head = column.drop_nulls().head(100)
        dated = head.str.contains(r"^\s*\d{4}-\d{2}-\d{2}[T ]\d").sum()
        if dated <= len(head) / 2:
            return 0.0, ""
        stamp = column.str.strip_chars().str.to_datetime(time_unit="us", strict=False, time_zone="UTC")
    return _rising(stamp.dt.epoch("us")), "iso8601"


def _unit(name: str, column: pl.Series) -> str:
    """By a unit in the name, by the size of Unix time, else the unit that makes the interval usual."""
    bracket = re.search(r"[\[(]([^\[\]()]*)[\])]\s*$", name)
    if bracket and bracket[1].strip() in _NAMED_UNITS:
        return _NAMED_UNITS[bracket[1].strip()]
    unix = _unix_unit(column)
    if unix is not None:
        return unix
    for unit, pattern in _UNIT_WORDS:
        if re.search(pattern, name.lower()):
            return unit
    reading = column.cast(pl.Float64).drop_nulls().to_numpy()
    step = float(np.median(np.diff(reading))) if len(reading) > 1 else 1.0
    return min(_SPAN, key=lambda unit: abs(np.log(max(step, 1e-12) * _SPAN[unit] / _USUAL_STEP_S)))


def _unix_unit(column: pl.Series) -> str | None:
    """The unit in which a column is Unix time."""
    return next((unit for unit in _SPAN if _is_unix(column, unit)), None)


def _is_unix(column: pl.Series, unit: str) -> bool:
    if unit == "iso8601":
        return True
    known = column.drop_nulls()
    return bool(len(known)) and is_unix(float(known[0]) * _SPAN[unit])
