"""Dates and clocks as text: which form a column has, and its microseconds. polars reads them; this picks the format."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from itertools import product

import polars as pl

CLOCKS = ("%H:%M:%S%.f", "%I:%M:%S%.f %p", "%H:%M:%S:%3f", "%H:%M", "%I:%M %p")
DAYS = (
    *("%Y-%m-%d", "%Y/%m/%d", "%Y.%m.%d", "%Y:%m:%d", "%Y%m%d", "%d.%m.%Y", "%d.%m.%y"),
    *("%m/%d/%Y", "%d/%m/%Y", "%d-%m-%Y", "%m-%d-%Y", "%m/%d/%y", "%d/%m/%y", "%d-%m-%y", "%m-%d-%y"),
    *("%y-%m-%d", "%y/%m/%d"),
    *("%d-%B-%Y", "%d %B %Y", "%d/%B/%Y", "%d-%B-%y", "%B %d %Y", "%B %d, %Y", "%Y-%B-%d"),
)
_COMPACT = ("%H%M%S%.f", "%H%M%S")
_BETWEEN = (" ", "T", "_", ", ", "-")
_WHOLE = ("%Y%m%d%H%M%S%.f", "%B %d %H:%M:%S%.f %Y", "%B %d %H:%M:%S%.f%z %Y")
READABLE = (
    "seconds, Unix time, 2024-05-01T10:00:00.1, 05/01/2024 10:00:00.1 AM, 01.05.2024 10:00:00, 01-May-2024 10:00:00, "
    "20240501T100000, 10:00:00.1"
)
_YEARS_US = (0, 4_102_444_800_000_000)  # 1970 to 2100
_SAMPLE = 1000
_MOST = 0.8  # share of the cells that a form must read
_FRACTION = re.compile(r"(?<=:\d\d)[.,]\d+|(?<=\d{6})[.,]\d+")
_TIDY = (  # what people and programs write around a date
    (r"\s+", " "),
    (r"^[\s\"']+|[\s\"']+$", ""),
    (r"(:\d\d|\d{6}),(\d)", "${1}.${2}"),
    (r"(?i)^(mon|tues?|wed(nes)?|thu(rs)?|fri|sat(ur)?|sun)(day)?\.?,? ", ""),
    (r"(?i)([ap])\.m\.", "${1}m"),
    (r"(?i)(\d)([ap]m)$", "${1} ${2}"),
    (r"(\d) ?(?:GMT|UTC)?([+-]\d\d):?(\d\d)( \d{4})?$", "${1}${2}${3}${4}"),
    (r"(\d) ?(Z|UTC|GMT)( \d{4})?$", "${1}${3}"),
    (r"([T :]\d\d:\d\d(?::\d\d(?:\.\d+)?)?[+-]\d\d)$", "${1}00"),
)


@dataclass(frozen=True)
class Form:
    """A format that reads a column. `other`: one that reads it just as well, day and month exchanged."""

    format: str
    other: str = ""

    @property
    def has_day(self) -> bool:
        return "%d" in self.format

    @property
    def has_clock(self) -> bool:
        return "%M" in self.format


def microseconds(cells: pl.Series, form: str) -> pl.Series:
    """Unix time [us], or the time since midnight where the form has no day; null where a cell cannot be read so."""
    cells = as_text(cells)
    found = _read(cells, form)
    missed = found.is_null() & cells.is_not_null()
    if missed.any():
        found = found.zip_with(~missed, _read(_tidy(cells), form))
    return found


def form_of(cells: pl.Series) -> Form | None:
    """The form of a column of text; day first or month first is decided over the whole column."""
    known = as_text(cells).drop_nulls()
    sample = _tidy(known.gather_every(max(1, len(known) // _SAMPLE)).head(_SAMPLE)).unique(maintain_order=True)
    if not len(sample):
        return None
    shapes = {_shape(cell) for cell in sample.head(20)}
    forms = [form for shape in shapes for form in _forms().get(shape, ())]
    able = [form for form in dict.fromkeys(forms) if _share(sample, form) >= _MOST]
    if len(able) < 2:
        return Form(able[0]) if able else None
    read = {form: microseconds(known, form) for form in able}
    most = max(len(one) - one.null_count() for one in read.values())
    ranked = sorted(
        (_leaps(one), able.index(form), form) for form, one in read.items() if len(one) - one.null_count() == most
    )
    even = [form for leaps, _, form in ranked[1:] if leaps == ranked[0][0]]
    return Form(ranked[0][2], even[0] if even else "")


def form_of_cells(cells: Sequence[str]) -> Form | None:
    """The same for a few cells."""
    return form_of(pl.Series(list(cells), dtype=pl.String))


def as_text(cells: pl.Series) -> pl.Series:
    """As text; a number such as 20240501 without a point, or 20240501100000.5 with all of its digits."""
    if cells.dtype.is_float():
        if (cells == cells.round()).all():
            return cells.cast(pl.Int64, strict=False).cast(pl.String)
        whole = cells.floor().cast(pl.Int64, strict=False)
        part = ((cells - cells.floor()) * 1000).round().cast(pl.Int64, strict=False).clip(0, 999)
        return whole.cast(pl.String) + "." + part.cast(pl.String).str.zfill(3)
    return cells.cast(pl.String)


def _tidy(cells: pl.Series) -> pl.Series:
    for pattern, into in _TIDY:
        cells = cells.str.replace_all(pattern, into)
    return cells


def _read(cells: pl.Series, form: str) -> pl.Series:
    try:
        if "%d" not in form:
            return cells.str.to_time(form, strict=False).cast(pl.Int64) // 1000
        if "%H" not in form and "%I" not in form:
            found = cells.str.to_date(form, strict=False).cast(pl.Datetime("us")).to_physical()
        else:
            found = cells.str.to_datetime(form, time_unit="us", strict=False).to_physical()
    except pl.exceptions.PolarsError:
        return pl.Series(cells.name, [None] * len(cells), dtype=pl.Int64)
    return found.set((found < _YEARS_US[0]) | (found >= _YEARS_US[1]), None)


def _share(cells: pl.Series, form: str) -> float:
    return 1 - _read(cells, form).null_count() / len(cells)


def _leaps(read: pl.Series) -> tuple[int, int]:
    """How often the time goes back, and how far it runs: of two readings of a date, the one with less is right."""
    step = read.drop_nulls().diff().drop_nulls()
    return int((step < 0).sum()), int(step.abs().sum())


@cache
def _forms() -> dict[str, list[str]]:
    """All formats by their shape."""
    clocks = [(clock, zone) for clock in (*CLOCKS, *_COMPACT[:1]) for zone in ("", "%z")]
    whole = [f"{day}{between}{clock}{zone}" for day, between, (clock, zone) in product(DAYS, _BETWEEN, clocks)]
    shapes: dict[str, list[str]] = {}
    for form in (*CLOCKS, *DAYS, *whole, *_WHOLE):
        shapes.setdefault(_shape_of(form), []).append(form)
    return shapes


def _shape(cell: str) -> str:
    """`05/01/2024 10:00:00.1 AM` is `0/0/0 0:0:0 A`."""
    return re.sub(r"[^\W\d_]+", "A", re.sub(r"\d+", "0", _FRACTION.sub("", cell))).replace("+", "-")


def _shape_of(form: str) -> str:
    named = re.sub(r"%[Bp]", "A", form.replace("%.f", "").replace("%z", "-0"))
    return re.sub(r"[^\W\d_]+", "A", re.sub(r"(%3f|%[A-Za-z])+", "0", named))
