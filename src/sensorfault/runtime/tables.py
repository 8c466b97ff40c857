"""A detection as tables: Polars data frames, or pandas ones where that is installed.

Every table of ticks begins with `time_s`, the log's clock [s]. Null (NaN in pandas) stands where there was nothing to
test. Residuals and scores are as the method computed them: SI, not the channels' own units.
"""

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import polars as pl

from sensorfault.core.types import VERDICTS
from sensorfault.events.event import Event
from sensorfault.events.export.tables import frame
from sensorfault.logs.table import LogError

if TYPE_CHECKING:
    from sensorfault.runtime.result import Detection

_VERDICT = pl.Enum(VERDICTS)


def events_table(events: Sequence[Event], pandas: bool = False) -> Any:
    """One row an event, by onset: start_s, end_s [s], subject, sensor, channel, kind, peak_score, limit, method.

    Null: an end where the event is ongoing, a sensor or channel where none can be named, a score where there is none.

    Args:
        events: what a detection found.
        pandas: give a pandas DataFrame instead of a Polars one.

    Raises:
        ImportError: pandas is asked for and not installed.
    """
    return _given(frame(events), pandas)


def verdicts_table(found: "Detection", channels: bool = False, pandas: bool = False) -> Any:
    """One row a tick: `ok`, `unknown` or `fault` of the whole `sample`, of the vehicle's `motion` and of each sensor.

    A fault of the sample with no sensor at fault means that nobody could be named. The words are ordered
    (Polars Enum, pandas Categorical): ok < unknown < fault.

    Args:
        found: the detection, T ticks.
        channels: also one column a channel, `sensor.channel`.
        pandas: give a pandas DataFrame instead of a Polars one.

    Raises:
        ImportError: pandas is asked for and not installed.
    """
    pairs = [("sample", found.sample), ("motion", found.motion)]
    pairs += [(sensor.name, found.sensor[:, i]) for i, sensor in enumerate(found.log.sensors)]
    if channels:
        pairs += [(channel.path, found.channel[:, i]) for i, channel in enumerate(found.log.channels)]
    words = np.array(VERDICTS)
    return _given(_ticks(found, ((name, pl.Series(words[code], dtype=_VERDICT)) for name, code in pairs)), pandas)


def scores_table(found: "Detection", pandas: bool = False) -> Any:
    """One row a tick, two columns a test: `NAME of CHANNEL` is its score, `NAME of CHANNEL, limit` its limit.

    A test that examines all channels is `NAME`. A fault is where the score is above the limit; both have the
    statistic's own unit. Null where the test had nothing to test. Tests that never tested anything are left out.

    Args:
        found: the detection, T ticks.
        pandas: give a pandas DataFrame instead of a Polars one.

    Raises:
        ImportError: pandas is asked for and not installed.
    """
    pairs = []
    for trace in found.traces:
        name = f"{trace.name} of {trace.channel}" if trace.channel else trace.name
        pairs += [(name, trace.score), (f"{name}, limit", trace.limit)]
    return _given(_ticks(found, pairs), pandas)


def residuals_table(found: "Detection", pandas: bool = False) -> Any:
    """One row a tick, one column a channel, `sensor.channel`: measured minus expected.

    In SI, as the method compares them: metres for positions given in degrees. Null where the residual was not tested:
    no new measurement, not warmed up, or a channel that the method does not judge.

    Args:
        found: the detection, T ticks, C channels.
        pandas: give a pandas DataFrame instead of a Polars one.

    Raises:
        LogError: the detection keeps no residuals.
        ImportError: pandas is asked for and not installed.
    """
    if found.residual is None:
        raise LogError(f"{found.log.name}: this detection keeps no residuals; run sf.detect on the log as a whole.")
    residual = found.residual
    return _given(_ticks(found, ((c.path, residual[:, i]) for i, c in enumerate(found.log.channels))), pandas)


def _ticks(found: "Detection", columns: Iterable[tuple[str, Any]]) -> pl.DataFrame:
    """A table with the log's times; a name that stands there already gets a number."""
    named: dict[str, pl.Series] = {"time_s": pl.Series(found.log.time)}
    for name, values in columns:
        count, unique = 1, name
        while unique in named:
            count += 1
            unique = f"{name} ({count})"
        named[unique] = pl.Series(values, nan_to_null=True) if isinstance(values, np.ndarray) else values
    return pl.DataFrame(named)


def _given(table: pl.DataFrame, pandas: bool) -> Any:
    return _to_pandas(table) if pandas else table


def _to_pandas(table: pl.DataFrame) -> Any:
    """Column by column: Polars' own way needs pyarrow besides."""
    try:
        import pandas as pd
    except ImportError:
        raise ImportError("pandas is not installed; run `pip install pandas`, or leave out pandas=True.") from None
    columns: dict[str, Any] = {}
    for column in table:
        if column.dtype == _VERDICT:
            columns[column.name] = pd.Categorical.from_codes(column.to_physical().to_numpy(), VERDICTS, ordered=True)
        else:
            columns[column.name] = column.to_numpy()
    return pd.DataFrame(columns)
