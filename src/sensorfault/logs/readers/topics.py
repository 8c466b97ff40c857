"""Messages by topic -> one table for each topic that holds numbers."""

from array import array
from collections.abc import Callable
from operator import attrgetter
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from sensorfault.logs.readers.fields import Fields
from sensorfault.logs.readers.handing import Handing
from sensorfault.logs.readers.ros_types import si_unit_of
from sensorfault.logs.readers.source import PART, Ask, Source, Tables, told

RECEIVED, STAMP = "received_time", "header.stamp"
_APART_S = 3600.0  # stamps so far from the recording's clock are of another clock
_RISING = 0.8  # share of the stamps that must be later than the one before
_NS = 10**9
_LATEST_NS = 2**63 - 1  # what a column of whole numbers holds


class Topics:
    """Gathers messages. What is kept of a message is eight bytes a number, so that pictures cost nothing.

    `unit_of(type, field)`: the unit that the format's documents name, or nothing.
    """

    def __init__(self, path: Path, ask: Ask, unit_of: Callable[[str, str], str] = si_unit_of) -> None:
        self.path, self.ask, self.unit_of = path, ask, unit_of
        self._topics: dict[str, _Topic] = {}
        self._unknown: dict[str, str] = {}
        self._numbers = 0  # gathered since the last part
        self._handing = Handing(ask)

    @property
    def handed_on(self) -> bool:
        """Whether a part has been."""
        return self._handing.begun

    def take(self, topic: str, kind: str, received_ns: int, message: Any) -> None:
        """One decoded message."""
        if topic not in self._topics:
            self._topics[topic] = _Topic(kind, message)
        self._topics[topic].take(received_ns, message)
        self._numbers += len(self._topics[topic].fields.names)
        if self._handing.asked and self._numbers >= PART:
            self._handing.on(told(self._gathered(), self._left_out()))
            for of_it in self._topics.values():
                of_it.clear()
            self._numbers = 0

    def cannot(self, topic: str, why: str) -> None:
        """A topic whose messages nobody can decode."""
        self._unknown.setdefault(topic, why)

    def tables(self) -> tuple[Tables, list[str]]:
        """The tables, or the last part of them, and what was left out, in sentences."""
        return self._handing.rest(self._gathered()), self._left_out()

    def _left_out(self) -> list[str]:
        notes: list[str] = []
        bare, cut = [], []
        for topic, of_it in self._topics.items():
            if len(of_it.fields.names) == 0:
                bare.append(f"{topic} ({of_it.kind})")
                continue
            cut += [f"{topic}.{field}" for field in of_it.fields.left_out]
        unknown = [f"{topic} ({why})" for topic, why in sorted(self._unknown.items())]
        for what, listed in (
            ("topics of unknown type", unknown),
            ("topics without numbers", bare),
            ("fields that are no measurements", cut),
        ):
            if listed:
                notes.append(f"{self.path.name}: {what} left out: {', '.join(listed)}.")
        return notes

    def _gathered(self) -> Tables:
        """A topic without a row is none: no message could be decoded, which its reader says, or all are handed on."""
        return {
            topic: of_it.table(self.path, topic, self.unit_of)
            for topic, of_it in self._topics.items()
            if of_it.rows and of_it.fields.names
        }


class _Topic:
    def __init__(self, kind: str, first: Any) -> None:
        self.kind, self.fields = kind, Fields(first)
        self._stamp = None if isinstance(first, dict) or not _stamp_ns(first) else attrgetter(f"{STAMP}")
        self.clear()

    @property
    def rows(self) -> int:
        return len(self._received)

    def clear(self) -> None:
        self._received, self._stamps, self._rows = array("q"), array("q"), array("d")

    def take(self, received_ns: int, message: Any) -> None:
        if self._stamp is not None:
            stamp = self._stamp(message)
            stamp_ns = stamp.sec * _NS + stamp.nanosec
        else:
            stamp_ns = _stamp_ns(message)
        received_ns, stamp_ns = min(received_ns, _LATEST_NS), max(-_LATEST_NS, min(stamp_ns, _LATEST_NS))
        self.fields.take(message, self._rows)
        self._received.append(received_ns)
        self._stamps.append(stamp_ns)

    def table(self, path: Path, topic: str, unit_of: Callable[[str, str], str]) -> Source:
        received, stamp = np.array(self._received), np.array(self._stamps)
        rows = np.array(self._rows).reshape(len(received), -1)
        names = [(i, name) for i, name in enumerate(self.fields.names) if not name.startswith(f"{STAMP}.")]
        columns = {RECEIVED: received, STAMP: stamp} if stamp.any() else {RECEIVED: received}
        columns |= {name: np.ascontiguousarray(rows[:, i]) for i, name in names}
        frame = pl.DataFrame({name: pl.Series(name, column, nan_to_null=False) for name, column in columns.items()})
        time, notes = _clock(path, topic, received, stamp)
        units = {name: unit for _, name in names if (unit := unit_of(self.kind, name))}
        return Source(path, frame, time, "ns", notes=tuple(notes), units=units)


def _stamp_ns(message: Any) -> int:
    """When the sensor measured, by its own driver; 0 if it does not say."""
    stamp = _member(_member(message, "header"), "stamp")
    second, rest = _member(stamp, "sec"), _member(stamp, "nanosec")
    return int(second or 0) * _NS + int(rest or 0)


def _member(part: Any, name: str) -> Any:
    return part.get(name) if isinstance(part, dict) else getattr(part, name, None)


def _clock(path: Path, topic: str, received: np.ndarray, stamp: np.ndarray) -> tuple[str, list[str]]:
    """The stamps, which tell when was measured, if they can be believed; else when the recorder heard of it."""
    if not stamp.any():
        return RECEIVED, []
    if len(stamp) > 1 and np.mean(np.diff(stamp) > 0) < _RISING:
        return RECEIVED, [f"{path.name}: the stamps of {topic} do not rise; the time of reception counts instead."]
    apart_s = float(np.median((stamp - received) / _NS))
    if abs(apart_s) > _APART_S:
        return RECEIVED, [
            f"{path.name}: the stamps of {topic} are of another clock, {apart_s:.6g} s off the recording's; "
            "the time of reception counts instead."
        ]
    return STAMP, []
