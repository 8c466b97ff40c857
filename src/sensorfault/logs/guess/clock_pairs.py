"""Clocks in two columns: a date and a clock, seconds and their rest, GPS week and time of week."""

import re
from itertools import product

import polars as pl

from sensorfault.logs.dates import Form, form_of
from sensorfault.logs.entries import FileEntry
from sensorfault.logs.guess.clocks import Candidate, steps
from sensorfault.logs.guess.time_names import bare
from sensorfault.logs.readers.source import Source
from sensorfault.logs.stamps import seconds

_WEEK = re.compile(r"(^|_)(week|wn|wno|gps_?week)(_?(no|num|number))?$")
_OF_WEEK = re.compile(r"(^|_)(i?tow|time_?of_?week|gps_?(time|seconds|secs|ms)|week_?(seconds|secs|ms)|sow)(_(s|ms))?$")
_WHOLE = re.compile(r"(^|_)(tv_)?(s|secs?|seconds?|time_s)$")
_REST = (
    ("ns", re.compile(r"(^|_)(tv_)?(ns|nsecs?|nanos|nano_?secs?|nano_?seconds?)$"), 1e9),
    ("us", re.compile(r"(^|_)(tv_)?(us|usecs?|micros|micro_?secs?|micro_?seconds?)$"), 1e6),
    ("ms", re.compile(r"(^|_)(ms|msecs?|millis|milli_?secs?|milli_?seconds?)$"), 1e3),
)
_GPS_WEEKS = (1000, 4000)


def pairs(source: Source) -> list[Candidate]:
    """The clocks in two columns of a table."""
    found = [*_dates(source), *_seconds(source), *_weeks(source)]
    return [_judged(source, file, sure) for file, sure in found]


def _judged(source: Source, file: FileEntry, sure: bool) -> Candidate:
    _, time = seconds(source, file)
    return Candidate(file, True, sure, *steps(pl.Series(time).fill_nan(None)))


def _dates(source: Source) -> list[tuple[FileEntry, bool]]:
    """The first date with the clock that is nearest to it."""
    forms = {name: form for name, form in _forms(source).items() if form.has_day != form.has_clock}
    days = [name for name, form in forms.items() if form.has_day]
    clocks = [name for name, form in forms.items() if form.has_clock]
    if not days or not clocks:
        return []
    order = source.frame.columns
    day, clock = min(product(days, clocks), key=lambda two: (abs(order.index(two[0]) - order.index(two[1])), two))
    unit = f"{forms[day].format} {forms[clock].format}"
    other = forms[day].other
    doubt = f"'{day}' is read as {forms[day].format}, but {other} reads it as well" if other else ""
    why = "a date and a clock by their form; unit as Unix time"
    return [(FileEntry(time=day, fine=clock, unit=unit, why=why, doubt=doubt), True)]


def _forms(source: Source) -> dict[str, Form]:
    """Text that is a date or a clock; and numbers like 20240501 that are called a date."""
    found = {}
    for name in source.frame.columns:
        column = source.frame[name]
        if column.dtype == pl.String:
            form = form_of(column)
        elif column.dtype.is_numeric() and re.search(r"(^|_)date(_|$)", bare(name)):
            form = form_of(column.cast(pl.Int64, strict=False))
        else:
            continue
        if form is not None:
            found[name] = form
    return found


def _seconds(source: Source) -> list[tuple[FileEntry, bool]]:
    names = {name: bare(name) for name in source.frame.columns if source.frame[name].dtype.is_numeric()}
    found = []
    for (one, whole), (two, rest) in product(names.items(), names.items()):
        seen = _WHOLE.search(whole)
        for unit, pattern, most in _REST:
            part = pattern.search(rest)
            if seen and part and whole[: seen.start()] == rest[: part.start()] and _within(source, two, 0, most):
                cells = source.frame[one].drop_nulls().cast(pl.Float64)
                if len(cells) and (cells == cells.round()).all():
                    why = "whole seconds and their rest, by name"
                    found.append((FileEntry(time=one, fine=two, unit=f"s+{unit}", why=why), float(cells[0]) > 9e8))
    return found


def _weeks(source: Source) -> list[tuple[FileEntry, bool]]:
    names = {name: bare(name) for name in source.frame.columns if source.frame[name].dtype.is_numeric()}
    weeks = [name for name, plain in names.items() if _WEEK.search(plain) and _within(source, name, *_GPS_WEEKS)]
    times = [name for name, plain in names.items() if _OF_WEEK.search(plain)]
    for week, time in product(weeks, times):
        unit = "s" if _within(source, time, 0, 604_800.1) and not re.search(r"ms|itow", names[time]) else "ms"
        if _within(source, time, 0, 604_800_100):
            return [
                (FileEntry(time=week, fine=time, unit=f"week+{unit}", why="GPS week and time of week, by name"), False)
            ]
    return []


def _within(source: Source, name: str, least: float, most: float) -> bool:
    known = source.frame[name].drop_nulls()
    return bool(len(known)) and bool(known.is_between(least, most, closed="left").all())
