"""A detection as tables: Polars data frames, or pandas ones where that is installed. Null is NaN in pandas."""

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float, Int8

from sensorfault.core.extras import require
from sensorfault.core.verdicts import VERDICTS
from sensorfault.events.event import Event
from sensorfault.events.export.tables import frame
from sensorfault.logs.table import Log, LogError

if TYPE_CHECKING:
    import polars

Test = tuple[str, Float[np.ndarray, " T"], Float[np.ndarray, " T"]]  # name, score, limit


def events_table(events: Sequence[Event], pandas: bool) -> Any:
    """One row an event."""
    require("a table", "polars")
    return _given(frame(events), pandas)


def verdicts_table(
    log: Log,
    sample: Int8[np.ndarray, " T"],
    motion: Int8[np.ndarray, " T"],
    sensor: Int8[np.ndarray, "T S"],
    channel: Int8[np.ndarray, "T C"] | None,
    pandas: bool,
) -> Any:
    """One row a tick, verdicts as ordered words; without channels where they are None."""
    require("a table", "polars")
    import polars as pl

    pairs = [("sample", sample), ("motion", motion)]
    pairs += [(one.name, sensor[:, i]) for i, one in enumerate(log.sensors)]
    if channel is not None:
        pairs += [(one.path, channel[:, i]) for i, one in enumerate(log.channels)]
    words, verdict = np.array(VERDICTS), pl.Enum(VERDICTS)
    return _given(_ticks(log, [(name, pl.Series(words[code], dtype=verdict)) for name, code in pairs]), pandas)


def scores_table(log: Log, tests: Iterable[Test], pandas: bool) -> Any:
    """One row a tick, two columns a test."""
    require("a table", "polars")
    pairs = [pair for name, score, limit in tests for pair in ((name, score), (f"{name}, limit", limit))]
    return _given(_ticks(log, [(name, _numbers(values)) for name, values in pairs]), pandas)


def residuals_table(log: Log, residual: Float[np.ndarray, "T C"] | None, pandas: bool) -> Any:
    """One row a tick, one column a channel.

    Raises:
        LogError: there are no residuals.
    """
    if residual is None:
        raise LogError(f"{log.name}: this detection keeps no residuals; run sf.detect on the log as a whole.")
    require("a table", "polars")
    columns = [(channel.path, _numbers(residual[:, i])) for i, channel in enumerate(log.channels)]
    return _given(_ticks(log, columns), pandas)


def _numbers(values: np.ndarray) -> "polars.Series":
    import polars as pl

    return pl.Series(values, nan_to_null=True)


def _ticks(log: Log, columns: "Iterable[tuple[str, polars.Series]]") -> "polars.DataFrame":
    """A table with the log's times; a name that is taken gets a number."""
    import polars as pl

    named = {"time_s": pl.Series(log.time)}
    for name, values in columns:
        count, unique = 1, name
        while unique in named:
            count += 1
            unique = f"{name} ({count})"
        named[unique] = values
    return pl.DataFrame(named)


def _given(table: "polars.DataFrame", pandas: bool) -> Any:
    return _to_pandas(table) if pandas else table


def _to_pandas(table: "polars.DataFrame") -> Any:
    """Column by column: Polars' own way needs pyarrow besides.

    Raises:
        ImportError: pandas is not installed.
    """
    import polars as pl

    try:
        import pandas as pd
    except ImportError:
        raise ImportError("pandas is not installed; run `pip install pandas`, or leave out pandas=True.") from None
    columns: dict[str, Any] = {}
    for column in table:
        if column.dtype == pl.Enum(VERDICTS):
            columns[column.name] = pd.Categorical.from_codes(column.to_physical().to_numpy(), VERDICTS, ordered=True)
        else:
            columns[column.name] = column.to_numpy()
    return pd.DataFrame(columns)
