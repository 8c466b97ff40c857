"""Write events as JSON lines, CSV or Parquet: one event a line, with the fields of Event."""

import json
from collections.abc import Sequence
from pathlib import Path

import polars as pl

from sensorfault.events.event import Event
from sensorfault.logs.table import Log

_SCHEMA = {
    "start_s": pl.Float64,
    "end_s": pl.Float64,
    "subject": pl.String,
    "sensor": pl.String,
    "channel": pl.String,
    "kind": pl.String,
    "peak_score": pl.Float64,
    "limit": pl.Float64,
    "method": pl.String,
}


def write_jsonl(events: Sequence[Event], log: Log, path: Path, source: Path | None) -> None:
    """One JSON object a line."""
    path.write_text("".join(json.dumps(event.as_dict(), allow_nan=False) + "\n" for event in events), encoding="utf-8")


def write_csv(events: Sequence[Event], log: Log, path: Path, source: Path | None) -> None:
    """With a header; an empty cell where there is no value."""
    _frame(events).write_csv(path)


def write_parquet(events: Sequence[Event], log: Log, path: Path, source: Path | None) -> None:
    """The same columns, null where there is no value."""
    _frame(events).write_parquet(path)


def _frame(events: Sequence[Event]) -> pl.DataFrame:
    return pl.DataFrame([event.as_dict() for event in events], schema=_SCHEMA)
