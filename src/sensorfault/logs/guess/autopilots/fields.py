"""Which column of a message is which channel."""

from dataclasses import dataclass

import numpy as np
import polars as pl

from sensorfault.logs.entries import ChannelEntry
from sensorfault.logs.readers.source import Source
from sensorfault.logs.table import SAID


@dataclass(frozen=True)
class Field:
    """A channel and its column, if the table has that.

    `valid`: conditions, of which the first counts whose column is there. `needs`: a further column that an older or
    newer form of the message has. `used`: a column of zeros is no channel. `large`: another unit where the usual value
    is larger than a number.
    """

    channel: str
    column: str
    unit: str = ""
    kind: str = ""
    watch: bool = True
    valid: tuple[str, ...] = ()
    missing: float | None = None
    needs: str = ""
    used: bool = False
    large: tuple[float, str] | None = None

    def entry(self, source: Source) -> ChannelEntry | None:
        """The channel in this table, None if it has none: no column, or one without a value."""
        columns = source.frame.columns
        if self.column not in columns or (self.needs and self.needs not in columns):
            return None
        value = self.value(source)
        valid = next((one for one in self.valid if one.split()[0] in columns), None)
        if (not np.isfinite(value).any() and valid is None) or (self.used and not np.nan_to_num(value).any()):
            return None
        unit = self.unit
        if self.large is not None and float(np.nanmedian(value)) > self.large[0]:
            unit = self.large[1]
        watch = self.watch and self.kind not in SAID
        return ChannelEntry(self.channel, self.column, unit, self.missing, watch=watch, valid=valid, kind=self.kind)

    def value(self, source: Source) -> np.ndarray:
        """The column, in its own unit; NaN where it has the mark of a missing value."""
        value = source.frame[self.column].cast(pl.Float64, strict=False).fill_null(np.nan).to_numpy()
        return value if self.missing is None else np.where(value == self.missing, np.nan, value)


def fields(kind: str = "", watch: bool = True, missing: float | None = None, **columns: str) -> tuple[Field, ...]:
    """`channel="column unit"`, the unit left out where it has none; several columns: `"one|other unit"`."""
    return _fields(kind, watch, missing, columns)


def _fields(kind: str, watch: bool, missing: float | None, columns: dict[str, str]) -> tuple[Field, ...]:
    return tuple(
        Field(channel, column, unit, kind, watch, missing=missing)
        for channel, text in columns.items()
        for names, _, unit in (text.partition(" "),)
        for column in names.split("|")
    )


def quality(missing: float | None = None, **columns: str) -> tuple[Field, ...]:
    """The same of what a sensor says of itself."""
    return _fields("quality", False, missing, columns)


def motor(current: str, speed: str, temperature: str) -> tuple[Field, ...]:
    """What a speed controller tells of its motor: columns with their units."""
    columns = {"current": current, "speed": speed, "temperature": temperature}
    return tuple(
        Field(channel, column, unit, "context", used=True)
        for channel, text in columns.items()
        for column, _, unit in (text.partition(" "),)
    )


def xyz(column: str, unit: str, marks: str = "xyz", kind: str = "") -> tuple[Field, ...]:
    """Three axes, whose columns differ by a mark."""
    return _fields(
        kind, True, None, {axis: f"{column.format(mark)} {unit}" for axis, mark in zip("xyz", marks, strict=True)}
    )
