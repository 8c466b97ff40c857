"""What makes one column a clock: its name, its unit or its form. That it rises makes none."""

import re
from dataclasses import dataclass

import numpy as np
import polars as pl

from sensorfault.logs.clock import is_unix
from sensorfault.logs.dates import form_of, microseconds
from sensorfault.logs.entries import FileEntry
from sensorfault.logs.guess.time_names import bare, is_named, unit_by_bracket, unit_by_word
from sensorfault.logs.guess.words import read_name
from sensorfault.logs.readers.source import Source
from sensorfault.logs.stamps import ISO_FORMS
from sensorfault.logs.time_units import DAY_ZERO, ISO, PER_SECOND, TICK_ZERO, TICKS_PER_SECOND, is_calendar

_FORWARD = 0.8  # share of the steps that must be forward
_SELDOM_BACK = 0.02  # of a clock that also stands still
_CERTAIN = 0.95  # share of forward steps where no name says that the column is a time
_REGULAR = 0.8  # share of the steps that must be alike then
_COUNTS = 3  # [whole numbers]: a column that rises by so few counts rows or packets
_DAYS = (20_000.0, 80_000.0)  # the years 1954 to 2119, in days since 1900
_DAY_STEP = 1e-3  # [days]: seconds of the day rise faster
_DIGITS = (19_700_101e6, 21_001_231e6)  # 20240501100000 and the like
_PLACE = re.compile(r"(^|_)(lat|lon|lng|latitude|longitude|id|seq|index|count|counter|number)(_|$)")
_USUAL_STEP_S = 0.05
_BY_SIZE = ("s", "ms", "us", "ns")


@dataclass(frozen=True)
class Candidate:
    """A column that may be the clock. `named`: by its name or unit; `sure`: its form says on which day it runs."""

    file: FileEntry
    named: bool
    sure: bool
    share: float  # of the steps that go forward
    back: float = 0.0  # of those that go back

    @property
    def rank(self) -> tuple[bool, bool, float]:
        return self.named, self.sure, round(self.share, 2)

    @property
    def runs(self) -> bool:
        return self.share >= _FORWARD

    @property
    def stands(self) -> bool:
        """Whether it stands still between its steps, as between whole seconds."""
        return (self.named or self.sure) and self.share > 0 and self.back <= _SELDOM_BACK


def candidate(source: Source, name: str, headed: bool) -> Candidate | None:
    """What a column is as a clock, if it may be one. `headed`: the columns have names."""
    column, named = source.frame[name], headed and is_named(name)
    if column.dtype == pl.String or column.dtype.is_temporal():
        return _calendar(name, column, named)
    if not column.dtype.is_numeric():
        return None
    said = (unit_by_bracket(name) or unit_by_bracket(f"[{source.units.get(name, '')}]")) if headed else None
    form = said or unit_by_form(column, named)
    if not named and said is None and headed and (form is None or read_name(name).kind or _PLACE.search(bare(name))):
        return None  # a longitude, or a distance, that rises
    share, back = steps(column)
    if not named and (share < _CERTAIN or _counts(column) or not _regular(column)):
        return None
    unit, why = form or "", "by its size"
    if said is not None:
        why = "by its name"
    elif form is None:
        unit, why = unit_by_word(name) or _usual_unit(column), "by name and usual interval"
    how = "by its name" if named else "by its unit" if said is not None else "by its form"
    sure = unit in (*DAY_ZERO, *TICK_ZERO) or is_calendar(unit) or _is_unix(column, unit)
    return Candidate(
        FileEntry(time=name, unit=unit, why=f"{how}; unit {'as Unix time' if sure and not said else why}"),
        named or said is not None,
        sure,
        share,
        back,
    )


def steps(column: pl.Series) -> tuple[float, float]:
    """The shares of the steps that go forward, and back."""
    step = np.diff(column.cast(pl.Float64).drop_nulls().to_numpy())
    return (float(np.mean(step > 0)), float(np.mean(step < 0))) if len(step) else (0.0, 0.0)


def _calendar(name: str, column: pl.Series, named: bool) -> Candidate | None:
    if column.dtype.is_temporal():
        moves = steps(column.dt.epoch("us")) if column.dtype in (pl.Datetime, pl.Date) else (0.0, 0.0)
        return Candidate(FileEntry(time=name, unit=ISO, why="by its form; unit as Unix time"), named, True, *moves)
    form = form_of(column)
    if form is None or not (form.has_clock or named):
        return None
    unit = ISO if form.format in ISO_FORMS else form.format
    ticks = microseconds(column, form.format)
    doubt = f"'{name}' is read as {form.format}, but {form.other} reads it as well" if form.other else ""
    how = "by its name" if named else "by its form"
    as_what = "as Unix time" if form.has_day else "as the time of day"
    file = FileEntry(time=name, unit=unit, why=f"{how}; unit {as_what}", doubt=doubt)
    return Candidate(file, named, form.has_day, *steps(ticks))


def unit_by_form(column: pl.Series, named: bool) -> str | None:
    """The unit in which a column of numbers is a date, by its size."""
    known = column.drop_nulls()
    unix = next((unit for unit in _BY_SIZE if _is_unix(known, unit)), None)
    if unix is not None or not len(known):
        return unix
    ticks = (unit for unit, zero in TICK_ZERO.items() if is_unix((float(known[0]) - zero) / TICKS_PER_SECOND))
    if (tick := next(ticks, None)) is not None:
        return tick
    least, most = float(known.min()), float(known.max())  # type: ignore[arg-type]
    if _DIGITS[0] <= least and most < _DIGITS[1] * 1000:
        form = form_of(known)
        return None if form is None else form.format
    if not named:
        return None
    step = np.diff(known.cast(pl.Float64).to_numpy())
    slow = len(step) > 0 and 0 < float(np.median(step)) < _DAY_STEP
    offset = {"excel": 0, "datenum": DAY_ZERO["datenum"] - DAY_ZERO["excel"]}
    days = (unit for unit, zero in offset.items() if _DAYS[0] <= least - zero and most - zero < _DAYS[1])
    return next(days, None) if slow else None


def _is_unix(column: pl.Series, unit: str) -> bool:
    known = column.drop_nulls()
    return unit in _BY_SIZE and bool(len(known)) and is_unix(float(known[0]) / PER_SECOND[unit])


def _counts(column: pl.Series) -> bool:
    """Whether a column counts rows or packets."""
    reading = column.cast(pl.Float64).drop_nulls().to_numpy()
    step = np.diff(reading)
    return len(step) > 0 and bool((reading == np.round(reading)).all()) and float(np.median(step)) <= _COUNTS


def _regular(column: pl.Series) -> bool:
    step = np.diff(column.cast(pl.Float64).drop_nulls().to_numpy())
    usual = float(np.median(step)) if len(step) else 0.0
    return usual > 0 and float(np.mean(np.abs(step - usual) <= usual / 2)) >= _REGULAR


def _usual_unit(column: pl.Series) -> str:
    """The unit that makes the interval usual."""
    reading = column.cast(pl.Float64).drop_nulls().to_numpy()
    step = np.diff(reading)
    forward = step[step > 0]
    usual = float(np.median(forward)) if len(forward) else 1.0
    if (reading != np.round(reading)).any() and usual < 1e3:
        return "s"
    return min(_BY_SIZE, key=lambda unit: abs(np.log(max(usual, 1e-12) / PER_SECOND[unit] / _USUAL_STEP_S)))
