"""Write events as JSON lines, CSV or Parquet: one event a line, with the fields of Event."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from sensorfault.events.event import Event
from sensorfault.logs.table import Log

if TYPE_CHECKING:
    import polars

_SCHEMA = {
    "start_s": float,
    "end_s": float,
    "subject": str,
    "sensor": str,
    "channel": str,
    "kind": str,
    "peak_score": float,
    "limit": float,
    "method": str,
    "found_by": str,
    "candidates": str,
}


def write_jsonl(events: Sequence[Event], log: Log, path: Path, source: Path | None) -> None:
    """One JSON object a line."""
    path.write_text("".join(json.dumps(event.as_dict(), allow_nan=False) + "\n" for event in events), encoding="utf-8")


def write_csv(events: Sequence[Event], log: Log, path: Path, source: Path | None) -> None:
    """With a header; an empty cell where there is no value."""
    import polars as pl

    # A spreadsheet runs what begins with one of these; an apostrophe makes it a word.
    table = frame(events)
    for name in (column.name for column in table if column.dtype == pl.String):
        words = pl.col(name)
        odd = words.str.contains(r"^[=+\-@\t\r]")
        table = table.with_columns(pl.when(odd).then("'" + words).otherwise(words).alias(name))
    table.write_csv(path)


def write_parquet(events: Sequence[Event], log: Log, path: Path, source: Path | None) -> None:
    """The same columns, null where there is no value."""
    frame(events).write_parquet(path)


def frame(events: Sequence[Event]) -> "polars.DataFrame":
    """A row an event, a column a field of Event, null where there is no value."""
    import polars as pl

    rows = [{**event.as_dict(), "candidates": ", ".join(event.candidates) or None} for event in events]
    return pl.DataFrame(rows, schema=_SCHEMA)
