"""What a reader returns: the columns of a file, unchanged."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path

import polars as pl

from sensorfault.logs.entries import SensorEntry
from sensorfault.logs.table import LogError


@dataclass(frozen=True)
class Damage:
    """A part of a file that cannot be read. `where`: a byte, a line or a time; `kept`: what was read all the same."""

    what: str
    where: str
    kept: str = "what came before was read"

    def sentence(self, path: Path) -> str:
        """`flight.ulg: the file breaks off at byte 4711; what came before was read.`"""
        return f"{path.name}: {self.what} at {self.where}; {self.kept}."


@dataclass(frozen=True)
class Ask:
    """A request to a reader. `tables`: those that are needed, None for all. `tell`: called with the share read, 0 to 1.

    `part`: is called with each part of a long file (PART numbers); the reader then returns the rest. Only for formats
    with `Format.parts`.
    """

    tables: frozenset[str] | None = None
    tell: Callable[[float], None] = field(default=lambda share: None, compare=False)
    part: "Callable[[Tables], None] | None" = None

    def wants(self, table: str) -> bool:
        """Whether a table is needed."""
        return self.tables is None or table in self.tables


ALL = Ask()
PART = 1 << 21  # numbers: 16 MB of them


@dataclass(frozen=True)
class Source:
    """One file's columns, untouched: numbers where every cell is a number, text elsewhere.

    `table`: its name, where the file holds several.
    `time` and `unit`: the time column and its unit where the format fixes them (RTKLIB does, CSV does not).
    `sensors`: what the columns are, where the format leaves nothing to guess.
    `first_line`: line of the file that row 0 came from, so that an error can name a line; 0 if rows have no lines.
    `lines`: row -> line, where rows were left out between them; else row n came from line `first_line` + n.
    `units`: the unit of each column whose format says it, spelled as in units.py.
    `times`: the file of its time column, where that is another file.
    `before`: rows of the table in parts of the file that were read before this one.
    `notes` and `damage` are those of the whole file, the same for each of its tables.
    """

    path: Path
    frame: pl.DataFrame
    time: str | None = None
    unit: str | None = None
    first_line: int = 0
    notes: tuple[str, ...] = ()
    damage: tuple[Damage, ...] = ()
    sensors: tuple[SensorEntry, ...] = ()
    units: Mapping[str, str] = field(default_factory=dict)
    table: str = ""
    times: Path | None = None
    before: int = 0
    lines: Callable[[int], int] | None = None

    @property
    def name(self) -> str:
        """Its name in messages: its file, and its table where the file holds several."""
        return f"{self.path.name} ({self.table})" if self.table else self.path.name

    def place(self, row: int) -> str:
        """The place of a row in the file, for messages."""
        if self.lines is not None:
            return f"line {self.lines(row)}"
        return f"line {row + self.first_line}" if self.first_line else f"row {row + self.before + 1}"

    def any_column(self, name: str) -> pl.Series:
        """One column as it is, numbers or not.

        Raises:
            LogError: no such column.
        """
        if name not in self.frame.columns:
            known = ", ".join(self.frame.columns)
            raise LogError(f"{self.path}: there is no column '{name}'; take one of {known}.")
        return self.frame[name]

    def column(self, name: str) -> pl.Series:
        """One column as numbers: float64, or int64 where a float could not hold it (nanoseconds since 1970).

        Raises:
            LogError: no such column, or a cell that is not a number.
        """
        column = self.any_column(name)
        if column.dtype == pl.Int64 or column.dtype == pl.Float64:
            return column
        if column.dtype.is_numeric() or column.dtype == pl.Boolean:
            return column.cast(pl.Float64)
        number = column.cast(pl.String).str.strip_chars().cast(pl.Float64, strict=False)
        bad = (number.is_null() & column.is_not_null()).arg_true()
        if len(bad):
            row = int(bad[0])
            raise LogError(
                f"{self.path}: {self.place(row)}, column '{name}' holds '{column[row]}', which is not a number; "
                "correct the cell, or leave the column out of vehicle.toml."
            )
        return number


Tables = dict[str, Source]  # the tables of one file by name; a format with one table a file calls it ""


def with_notes(tables: Tables, notes: Iterable[str], damage: Iterable[Damage] = ()) -> Tables:
    """The same tables with these notes and this damage."""
    said, broken = tuple(notes), tuple(damage)
    return {
        name: replace(one, notes=(*one.notes, *said), damage=(*one.damage, *broken)) for name, one in tables.items()
    }


def joined(before: Tables, now: Tables) -> Tables:
    """Each table's rows of two parts of a file, one after the other."""

    def both(one: Source | None, two: Source | None) -> Source:
        if one is None or two is None:
            only = one or two
            assert only is not None
            return only
        frame = pl.concat([one.frame, two.frame], how="diagonal_relaxed")
        notes, damage = dict.fromkeys((*one.notes, *two.notes)), dict.fromkeys((*one.damage, *two.damage))
        return replace(one, frame=frame, notes=tuple(notes), damage=tuple(damage))

    return {name: both(before.get(name), now.get(name)) for name in {**before, **now}}
