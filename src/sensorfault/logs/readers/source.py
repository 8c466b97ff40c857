"""What a reader of one format hands on: the file's columns as they stand in it."""

from dataclasses import dataclass
from pathlib import Path

import polars as pl

from sensorfault.logs.table import LogError


@dataclass(frozen=True)
class Source:
    """One file's columns, untouched: numbers where every cell is a number, text elsewhere.

    `time` and `unit`: the time column and its unit where the format fixes them (RTKLIB does, CSV does not).
    `first_line`: line of the file that row 0 came from, so that an error can name a line; 0 if rows have no lines.
    """

    path: Path
    frame: pl.DataFrame
    time: str | None = None
    unit: str | None = None
    first_line: int = 0
    notes: tuple[str, ...] = ()

    def place(self, row: int) -> str:
        """Where a row stands in the file, for a person."""
        return f"line {row + self.first_line}" if self.first_line else f"row {row + 1}"

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
            LogError: no such column, or a cell that is no number.
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
                "mend the cell, or leave the column out of vehicle.toml."
            )
        return number
