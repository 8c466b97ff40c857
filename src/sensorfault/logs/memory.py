"""Tables that are in memory already, as the columns that a reader of files would hand on."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, Protocol, TypeGuard, runtime_checkable

import numpy as np
import polars as pl

from sensorfault.core.expect import called
from sensorfault.logs.readers.attitude import with_attitude
from sensorfault.logs.readers.cells import MISSING, numbers_of
from sensorfault.logs.readers.source import Source
from sensorfault.logs.table import LogError

NAME = "table"
_EXACT_IN_FLOAT = 2**53


@runtime_checkable
class PandasTable(Protocol):
    """A pandas DataFrame; pandas itself need not be installed."""

    columns: Any
    index: Any

    def reset_index(self) -> Any: ...


Table = pl.DataFrame | Mapping[str, Any] | PandasTable


def is_table(thing: object) -> TypeGuard[Table]:
    """Whether `source_of` takes it."""
    return isinstance(thing, pl.DataFrame | Mapping | PandasTable)


def source_of(table: Table) -> Source:
    """The columns of a table, as the CSV reader would find them in a file of the same cells.

    A pandas index of dates, of times since some start, or with a name becomes the first column.

    Raises:
        LogError: no rows, two columns of one name, columns of unequal length, or something that is no column.
    """
    if isinstance(table, pl.DataFrame):
        columns = {column.name: column for column in table}
    elif isinstance(table, Mapping):
        columns = {str(name): _series(str(name), values) for name, values in table.items()}
    else:
        columns = _of_pandas(table)
    lengths = {name: len(column) for name, column in columns.items()}
    if len(set(lengths.values())) > 1:
        (one, rows), (other, others) = min(lengths.items(), key=_second), max(lengths.items(), key=_second)
        raise LogError(f"{NAME}: column '{one}' has {rows} rows and '{other}' has {others}; give as many of each.")
    flat = [name for name, column in columns.items() if not column.dtype.is_nested()]
    frame = pl.DataFrame({name: _plain(columns[name]) for name in flat})
    frame = frame.filter(~pl.all_horizontal(pl.all().is_null())) if flat else frame
    if not len(frame):
        raise LogError(f"{NAME}: the table is empty; give one with rows.")
    lost = len(columns) - len(flat)
    notes = (f"{NAME}: {lost} columns hold lists or structures and were left out.",) if lost else ()
    since = next((name for name in flat if columns[name].dtype == pl.Duration), None)
    return with_attitude(Source(Path(NAME), frame, time=since, unit=since and "s", notes=notes))


def _second(item: tuple[str, int]) -> int:
    return item[1]


def _series(name: str, values: Any) -> pl.Series:
    """One column of a mapping."""
    if isinstance(values, pl.Series):
        return values
    if hasattr(values, "notna"):
        return _pandas_series(values)
    if isinstance(values, str | bytes) or not hasattr(values, "__len__"):
        raise TypeError(f"read: column '{name}' is {called(values)}; give an array or a list, one value a row.")
    array = np.asarray(values)
    if array.ndim != 1:
        raise LogError(f"{NAME}: column '{name}' is an array of {array.ndim} axes; give one array a column.")
    return pl.Series(name, list(values) if array.dtype.kind in "OUS" else array, strict=False)


def _of_pandas(table: PandasTable) -> dict[str, pl.Series]:
    index: Any = table.index
    kind = getattr(getattr(index, "dtype", None), "kind", "")
    if kind in ("M", "m") or index.names != [None]:
        if index.names == [None]:
            index.name, table = None, table.reset_index().rename(columns={"index": "time"})
        else:
            table = table.reset_index()
    names = [str(name) for name in table.columns]
    twice = [name for name in names if names.count(name) > 1]
    if twice:
        raise LogError(f"{NAME}: two columns are called '{twice[0]}'; rename one.")
    columns: Any = table
    return {name: _pandas_series(columns.iloc[:, i]) for i, name in enumerate(names)}


def _pandas_series(column: Any) -> pl.Series:
    """A pandas column without pyarrow: numbers, dates and durations as NumPy has them, all else as Python objects."""
    kind = getattr(column.dtype, "kind", "O")
    if kind == "M":
        if getattr(column.dtype, "tz", None) is not None:
            column = column.dt.tz_convert("UTC").dt.tz_localize(None)
        return pl.Series(column.to_numpy())
    if kind == "m":
        return pl.Series(column.to_numpy())
    if kind in "iuf":
        whole = kind != "f" and column.notna().all()
        return pl.Series(column.to_numpy(dtype=np.int64 if whole else float, na_value=np.nan))
    cells = column.astype(object).tolist()
    known = column.notna().tolist()
    return pl.Series([cell if there else None for cell, there in zip(cells, known, strict=True)], strict=False)


def _plain(column: pl.Series) -> pl.Series:
    """Floats for numbers, integers only where a float would round them, dates as they are, text elsewhere."""
    dtype = column.dtype
    if dtype.is_integer():
        exact = dtype == pl.Int64 or dtype == pl.UInt64
        large = exact and bool((column.abs() > _EXACT_IN_FLOAT).any()) if dtype == pl.Int64 else False
        return column if large else column.cast(pl.Float64)
    if dtype.is_numeric() or dtype == pl.Null:
        return column.cast(pl.Float64).fill_nan(None)
    if dtype == pl.Duration:
        return column.dt.total_nanoseconds().cast(pl.Float64) / 1e9
    if dtype.is_temporal() or dtype == pl.Boolean:
        return column
    text = column.cast(pl.String) if dtype != pl.Object else pl.Series([str(cell) for cell in column])
    text = text.set(text.is_in(MISSING), None)
    return numbers_of(text)
