"""Text tables as people and programs write them: each draw is one dialect, and what it holds."""

import re
from collections.abc import Callable
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
from hypothesis import strategies as st

GPS_S = datetime(1980, 1, 6, tzinfo=UTC).timestamp()
LEAP_S = 18


@dataclass(frozen=True)
class Form:
    """A way to write times: the names of its columns, the cells for Unix time [s], how exact, whether it has a date."""

    names: tuple[str, ...]
    cells: Callable[[float], tuple[str, ...]]
    exact_s: float
    dated: bool = True
    blank: bool = False  # whether a cell holds a blank
    slowest_s: float = 0.0  # no period below this is told apart by it
    comma: bool = True  # whether it may have a decimal comma


def dated(form: str, digits: int = 3, **more: object) -> Form:
    """A form of strftime; `digits`: of the seconds' fraction, in the place of %f."""

    def cells(time: float) -> tuple[str, ...]:
        micro = round(time * 10**digits)
        stamp = datetime.fromtimestamp(micro // 10**digits, UTC)
        return (stamp.strftime(form.replace("%f", f"{micro % 10**digits:0{digits}d}")),)

    return Form(("time",), cells, 0.6 * 10**-digits, blank=" " in form, **more)  # type: ignore[arg-type]


def joined(first: Form, second: Form, names: tuple[str, str]) -> Form:
    return Form(names, lambda time: (*first.cells(time), *second.cells(time)), second.exact_s)


def number(name: str, scale: float, digits: int, zero: float = 0.0, **more: object) -> Form:
    """Unix time less `zero`, in units of `scale` a second."""

    def cells(time: float) -> tuple[str, ...]:
        if digits == 0:
            return (str(round((time - zero) * 1e6) * round(scale) // 10**6 if scale >= 1 else 0),)
        return (f"{(time - zero) * scale:.{digits}f}",)

    return Form((name,), cells, max(0.6 * 10.0**-digits / scale, 2e-6), **more)  # type: ignore[arg-type]


def week(time: float) -> tuple[str, str]:
    gps = round((time - GPS_S + LEAP_S) * 1e3)
    return str(gps // 604_800_000), f"{gps % 604_800_000 / 1e3:.3f}"


def since(time: float) -> float:
    return time - 1.7e9


FORMS: dict[str, Form] = {
    "seconds": number("time", 1.0, 3, 1.7e9, dated=False),
    "seconds [s]": number("t [s]", 1.0, 3, 1.7e9, dated=False),
    "milliseconds": number("time_ms", 1e3, 0, 1.7e9, dated=False),
    "ts": number("ts", 1.0, 3, 1.7e9, dated=False),
    "Unix s": number("timestamp", 1.0, 3),
    "Unix ms": number("timestamp", 1e3, 0),
    "Unix us": number("timestamp", 1e6, 0),
    "Unix ns": number("timestamp", 1e9, 0),
    "ISO": dated("%Y-%m-%dT%H:%M:%S.%f"),
    "ISO Z": dated("%Y-%m-%dT%H:%M:%S.%fZ"),
    "ISO blank": dated("%Y-%m-%d %H:%M:%S.%f", 6),
    "ISO zone": dated("%Y-%m-%dT%H:%M:%S.%f+00:00"),
    "ISO whole": dated("%Y-%m-%dT%H:%M:%S", 0, slowest_s=1.0),
    "slashes, year first": dated("%Y/%m/%d %H:%M:%S.%f"),
    "month first": dated("%m/%d/%Y %H:%M:%S.%f"),
    "month first, AM": dated("%m/%d/%Y %I:%M:%S.%f %p"),
    "day first, slashes": dated("%d/%m/%Y %H:%M:%S.%f"),
    "day first, dots": dated("%d.%m.%Y %H:%M:%S.%f"),
    "day first, comma": dated("%d.%m.%Y %H:%M:%S,%f"),
    "day first, dashes": dated("%d-%m-%Y %H:%M:%S.%f"),
    "compact": dated("%Y%m%dT%H%M%S.%f"),
    "month by name": dated("%d-%b-%Y %H:%M:%S.%f"),
    "clock": Form(("time",), dated("%H:%M:%S.%f").cells, 6e-4, dated=False),
    "clock, AM": Form(("time",), dated("%I:%M:%S.%f %p").cells, 6e-4, dated=False, blank=True),
    "date and clock": joined(dated("%Y-%m-%d"), dated("%H:%M:%S.%f"), ("Date", "Time")),
    "day.month and clock": joined(dated("%d.%m.%Y"), dated("%H:%M:%S.%f"), ("date", "time")),
    "secs and nsecs": Form(
        ("stamp.secs", "stamp.nsecs"),
        lambda time: (str(round(time * 1e3) // 1000), str(round(time * 1e3) % 1000 * 10**6)),
        6e-4,
        comma=False,
    ),
    "week and time of week": Form(("gps_week", "gps_tow"), week, 6e-4),
    "Excel": number("date_time", 1 / 86_400, 9, -25_569 * 86_400.0, slowest_s=0.01),
    "datenum": number("datenum_time", 1 / 86_400, 9, -719_529 * 86_400.0, slowest_s=0.01),
}
COLUMNS = (("ax", "m/s^2", 1.0), ("gyro, z", "deg/s", 20.0), ("speed", "km/h", 60.0), ("altitude", "m", 900.0))
SEPARATORS = {"comma": ",", "semicolon": ";", "tab": "\t", "pipe": "|", "blanks": "  "}
PREAMBLES = {
    "none": "",
    "#": "# made by a logger\n# version: 2\n\n",
    "//": "// made by a logger, firmware 1.2\n",
    "%": "% run 7 of 9\n",
    "keys": "Device: logger 7\nFirmware: 1.2\nStarted: today\n\n",
    "cells": "Device{0}logger 7\nRate{0}100\nStarted{0}today{0}at noon\n\n",
    "title": "Drive in the rain\n",
}


@dataclass(frozen=True)
class Table:
    """One drawn table: how it is written, and what it holds."""

    form: str
    separator: str
    preamble: str
    quoting: str
    units: str
    end: str
    encoding: str
    comma: bool
    grouped: bool
    trailing: bool
    index: bool
    decoy: bool
    missing: str
    again: bool
    start_s: float
    period_s: float
    rows: int
    seed: int

    @property
    def time(self) -> np.ndarray:
        return self.start_s + self.period_s * np.arange(self.rows)

    def values(self) -> dict[str, np.ndarray]:
        """The measurements by name, rounded as they are written; NaN where there is none."""
        random = np.random.default_rng(self.seed)
        found = {name: np.round(random.normal(size=self.rows) * size, 3) for name, _, size in COLUMNS}
        if self.grouped:
            found["altitude"] = np.round(1234.5 + np.abs(found["altitude"]), 1)
        if self.missing != "never":
            found["speed"][self.rows // 2] = np.nan
        return found

    def write(self, path: Path) -> None:
        path.write_bytes(self.text().replace("\n", self.end).encode(self.encoding))

    def text(self) -> str:
        form, values = FORMS[self.form], self.values()
        names = [*form.names, *(name for name, _, _ in COLUMNS)]
        units = [*("" for _ in form.names), *(unit for _, unit, _ in COLUMNS)]
        if self.units in ("[]", "()"):
            names = [
                f"{name} {self.units[0]}{unit}{self.units[1]}" if unit else name
                for name, unit in zip(names, units, strict=True)
            ]
        lead = (
            ["", "odometer"]
            if self.index and self.decoy
            else [""]
            if self.index
            else ["odometer"]
            if self.decoy
            else []
        )
        head = [[*lead, *names]] + ([[*("" for _ in lead), *units]] if self.units == "row" else [])
        body = []
        for k in range(self.rows):
            cells = ([str(k)] if self.index else []) + ([self._number(1.5 * k, 1)] if self.decoy else [])
            cells += [
                cell.replace(".", ",") if self._spells_comma(form, cell) else cell
                for cell in form.cells(float(self.time[k]))
            ]
            cells += [self._cell(name, values[name][k]) for name, _, _ in COLUMNS]
            body.append(cells)
        if self.again:
            body.insert(self.rows // 3, head[0])
        lines = [self._line(cells, header=True) for cells in head] + [self._line(cells, header=False) for cells in body]
        return PREAMBLES[self.preamble].format(SEPARATORS[self.separator]) + "\n".join(lines) + "\n"

    def _spells_comma(self, form: Form, cell: str) -> bool:
        return self.comma and form.comma and re.fullmatch(r"\d+\.\d+", cell) is not None

    def _cell(self, name: str, value: float) -> str:
        if not np.isfinite(value):
            return "" if self.missing == "empty" else self.missing
        if self.grouped and name == "altitude":
            plain = f"{value:,.1f}"
            return plain.translate(str.maketrans(",.", ".,")) if self.comma else plain
        return self._number(value, 3)

    def _number(self, value: float, digits: int) -> str:
        return f"{value:.{digits}f}".replace(".", "," if self.comma else ".")

    def _line(self, cells: list[str], header: bool) -> str:
        quoted = self.quoting == "all" or (self.quoting == "header" and header)
        separator = SEPARATORS[self.separator]
        return separator.join(_quoted(cell, separator, quoted) for cell in cells) + (
            separator.strip() if self.trailing else ""
        )


def _quoted(cell: str, separator: str, always: bool) -> str:
    must = separator.strip(" ") in cell if separator.strip(" ") else (" " in cell or not cell)
    return f'"{cell}"' if always or must or (not cell and separator == "  ") else cell


@st.composite
def tables(draw: st.DrawFn) -> Table:
    """Any dialect in which what the file means is not open to doubt."""
    name = draw(st.sampled_from(sorted(FORMS)))
    form, separator = FORMS[name], draw(st.sampled_from(sorted(SEPARATORS)))
    comma = draw(st.booleans()) and separator != "comma"
    periods = [period for period in (0.01, 0.02, 0.05, 0.1, 0.25, 1.0) if period >= form.slowest_s]
    day = draw(st.integers(13, 28))  # the 5th of April may be the 4th of May
    start = datetime(
        2024, draw(st.integers(1, 12)), day, draw(st.integers(0, 22)), draw(st.integers(0, 59)), 7, tzinfo=UTC
    )
    return Table(
        form=name,
        separator=separator,
        preamble=draw(st.sampled_from(sorted(PREAMBLES))),
        quoting=draw(st.sampled_from(["none", "header", "all"])),
        units=draw(st.sampled_from(["none", "[]", "()", "row"])),
        end=draw(st.sampled_from(["\n", "\r\n", "\r"])),
        encoding=draw(st.sampled_from(["utf-8", "utf-8-sig", "utf-16"])),
        comma=comma,
        grouped=draw(st.booleans()) and separator != "blanks",
        trailing=draw(st.booleans()) and separator != "blanks",
        index=draw(st.booleans()),
        decoy=draw(st.booleans()),
        missing=draw(st.sampled_from(["never", "empty", "NA", "NaN", "-", "N/A"])),
        again=draw(st.booleans()),
        start_s=start.timestamp(),
        period_s=draw(st.sampled_from(periods)),
        rows=draw(st.integers(20, 80)),
        seed=draw(st.integers(0, 2**31)),
    )
