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
from sensorfault.logs.readers.protobuf_fields import ProtobufFields
from sensorfault.logs.readers.ros_types import si_unit_of
from sensorfault.logs.readers.source import PART, Ask, Source, Tables, with_notes

RECEIVED = "received_time"
_STAMPS = ("header.stamp", "timestamp")  # ROS's, Foxglove's
_PARTS = (("sec", "nanosec"), ("sec", "nsec"), ("seconds", "nanos"))  # ROS's, Foxglove's in JSON, protocol buffers'
_APART_S = 3600.0  # stamps so far from the recording's clock are of another clock
_RISING = 0.8  # share of the stamps that must be later than the one before
_NS = 10**9
_LATEST_NS = 2**63 - 1  # what a column of whole numbers holds


class Topics:
    """Collects the numbers of messages, eight bytes each; pictures and scans are left out.

    `unit_of(type, field)`: the unit in the format's documentation, or nothing.
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
            self._handing.on(with_notes(self._gathered(), self._left_out()))
            for of_it in self._topics.values():
                of_it.clear()
            self._numbers = 0

    def cannot(self, topic: str, why: str) -> None:
        """A topic whose messages cannot be decoded."""
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
            ("fields that are not measurements", cut),
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
        self.kind = kind
        self.fields = ProtobufFields(first) if hasattr(first, "DESCRIPTOR") else Fields(first)
        result = ((path, parts) for path in _STAMPS for parts in _PARTS if None not in _parts(first, path, parts))
        self.stamp, self.stamp_parts = next(result, (_STAMPS[0], _PARTS[0]))
        quick = not isinstance(first, dict) and None not in _parts(first, self.stamp, self.stamp_parts)
        self._stamp = attrgetter(*(f"{self.stamp}.{part}" for part in self.stamp_parts)) if quick else None
        self.clear()

    @property
    def rows(self) -> int:
        return len(self._received)

    def clear(self) -> None:
        self._received, self._stamps, self._rows = array("q"), array("q"), array("d")

    def take(self, received_ns: int, message: Any) -> None:
        if self._stamp is not None:
            second, rest = self._stamp(message)
        else:
            second, rest = _parts(message, self.stamp, self.stamp_parts)
        # when the sensor measured, by its own driver; 0 if it does not say
        stamp_ns = int(second or 0) * _NS + int(rest or 0)
        received_ns, stamp_ns = min(received_ns, _LATEST_NS), max(-_LATEST_NS, min(stamp_ns, _LATEST_NS))
        self.fields.take(message, self._rows)
        self._received.append(received_ns)
        self._stamps.append(stamp_ns)

    def table(self, path: Path, topic: str, unit_of: Callable[[str, str], str]) -> Source:
        received, stamp = np.array(self._received), np.array(self._stamps)
        rows = np.array(self._rows).reshape(len(received), -1)
        names = [(i, name) for i, name in enumerate(self.fields.names) if not name.startswith(f"{self.stamp}.")]
        columns = {RECEIVED: received, self.stamp: stamp} if stamp.any() else {RECEIVED: received}
        columns |= {name: np.ascontiguousarray(rows[:, i]) for i, name in names}
        frame = pl.DataFrame({name: pl.Series(name, column, nan_to_null=False) for name, column in columns.items()})
        believed, notes = _believed(path, topic, received, stamp)
        units = {name: unit for _, name in names if (unit := unit_of(self.kind, name))}
        return Source(path, frame, self.stamp if believed else RECEIVED, "ns", notes=tuple(notes), units=units)


def _parts(message: Any, path: str, parts: tuple[str, str]) -> tuple[Any, Any]:
    """Seconds and nanoseconds, None where there are none."""
    for name in path.split("."):
        message = _member(message, name)
    return _member(message, parts[0]), _member(message, parts[1])


def _member(part: Any, name: str) -> Any:
    return part.get(name) if isinstance(part, dict) else getattr(part, name, None)


def _believed(path: Path, topic: str, received: np.ndarray, stamp: np.ndarray) -> tuple[bool, list[str]]:
    """Whether the stamps (times of measurement) can be trusted; else the time of reception is used."""
    if not stamp.any():
        return False, []
    if len(stamp) > 1 and np.mean(np.diff(stamp) > 0) < _RISING:
        return False, [f"{path.name}: the stamps of {topic} do not increase; the time of reception is used instead."]
    apart_s = float(np.median((stamp - received) / _NS))
    if abs(apart_s) > _APART_S:
        return False, [
            f"{path.name}: the stamps of {topic} are from another clock, {apart_s:.6g} s off the recording's; "
            "the time of reception is used instead."
        ]
    return True, []
