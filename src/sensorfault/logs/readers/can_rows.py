"""Decoded messages of a CAN bus -> one table for each message."""

from array import array
from math import nan
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from sensorfault.logs.readers.source import Source, Tables
from sensorfault.logs.units import known, spelled

TIME = "time"


class Rows:
    """Collects the numbers of messages, eight bytes each. `numbers`: how many there are."""

    def __init__(self) -> None:
        self.numbers = 0
        self._of: dict[str, tuple[Any, list[str], array[float]]] = {}  # by name: its type, its signals, its rows

    def take(self, message: Any, time: float, signals: dict[str, Any]) -> None:
        """One message with its signals; a multiplexed message has only some of them."""
        if message.name not in self._of:
            self._of[message.name] = message, [signal.name for signal in message.signals], array("d")
        _, names, rows = self._of[message.name]
        rows.append(time)
        for name in names:
            value = signals.get(name)
            rows.append(value if isinstance(value, int | float) else nan)
        self.numbers += 1 + len(names)

    def tables(self, path: Path, least: int) -> Tables:
        """The tables with at least this many rows, without signals that no message has."""
        tables = {name: _table(path, *one) for name, one in self._of.items()}
        return {name: one for name, one in tables.items() if len(one.frame) >= least and len(one.frame.columns) > 1}


def _table(path: Path, message: Any, names: list[str], rows: "array[float]") -> Source:
    value = np.array(rows).reshape(-1, 1 + len(names))
    columns = {TIME: value[:, 0]}
    columns |= {name: one for name, one in zip(names, value.T[1:], strict=True) if not np.isnan(one).all()}
    units = {signal.name: str(signal.unit) for signal in message.signals if signal.unit and known(str(signal.unit))}
    frame = pl.DataFrame({name: np.ascontiguousarray(column) for name, column in columns.items()})
    return Source(
        path, frame, TIME, "s", units={name: spelled(unit) for name, unit in units.items() if name in columns}
    )
