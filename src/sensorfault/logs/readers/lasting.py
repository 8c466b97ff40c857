"""States of a DataFlash log that are logged when they change: one that never did lasts until the end of the log."""

from dataclasses import replace

import polars as pl

from sensorfault.logs.readers.source import Source, Tables

_STATES = frozenset({"MODE", "ARM", "EV"})


def usable(tables: Tables) -> Tables:
    """The tables that make a series: those of several rows, and states."""
    ends: dict[str, float] = {}
    for one in tables.values():
        assert one.time is not None
        last = one.frame[one.time].max()
        ends[one.time] = max(ends.get(one.time, float("-inf")), float(last or 0))  # type: ignore[arg-type]
    states = {name: _until(one, ends) for name, one in tables.items() if name in _STATES}
    return {name: one for name, one in (tables | states).items() if len(one.frame) > 1}


def _until(state: Source, ends: dict[str, float]) -> Source:
    """The same state, once more at the end."""
    time = state.time or ""
    if len(state.frame) != 1 or state.frame[time][0] >= ends[time]:
        return state
    end = state.frame.with_columns(pl.lit(ends[time]).cast(state.frame[time].dtype).alias(time))
    return replace(state, frame=pl.concat([state.frame, end]))
