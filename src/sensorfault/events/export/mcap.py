"""Write events as annotations to an MCAP file: a log of starts and ends, and the state of each sensor.

The log's schema is that of Foxglove, from foxglove-sdk. The file is written with mcap, because foxglove-sdk's writer
cannot write the time when a message was published, nor attachments.
"""

import json
from collections.abc import Iterator, Sequence
from math import inf
from pathlib import Path
from typing import Any

from sensorfault.events.event import Event
from sensorfault.events.export.moments import NS, Moment, moments, sentence
from sensorfault.logs.table import Log

EVENTS, STATES = "/sensorfault/events", "/sensorfault/states"
_OK = "ok"


def write_mcap(events: Sequence[Event], log: Log, path: Path, source: Path | None) -> None:
    """Write a copy of `source`, as far as it can be read, with two more topics.

    `/sensorfault/events` (foxglove.Log) is for the log panel. `/sensorfault/states` (JSON) is for state transitions:
    for each sensor and for the vehicle's motion, `ok` or the kind of fault. It has a message at the beginning, at every
    change, and at the end, so that viewers draw the last state to the end of the log.
    """
    from mcap.writer import Writer

    from sensorfault.events.export.mcap_copy import copy, profile_of  # lazily: it needs the readers

    with path.open("wb") as file:
        writer: Any = Writer(file)
        writer.start(profile_of(source) if source is not None else "", "sensorfault")
        own = _Own(writer, events, log)
        if source is not None:
            copy(source, writer, own.until)
        own.until(inf)
        writer.finish()


class _Own:
    """The messages of the two topics, in order of time."""

    def __init__(self, writer: Any, events: Sequence[Event], log: Log) -> None:
        from foxglove.messages import Log as LogMessage

        schema = LogMessage.get_schema()
        number = writer.register_schema(schema.name, schema.encoding, schema.data)
        self._channels = {EVENTS: writer.register_channel(EVENTS, "protobuf", number)}
        number = writer.register_schema("sensorfault.States", "jsonschema", _schema(log))
        self._channels[STATES] = writer.register_channel(STATES, "json", number)
        self._writer = writer
        self._left = list(_said(events, log))[::-1]

    def until(self, time_ns: float) -> None:
        """Write those up to this time."""
        while self._left and self._left[-1][0] <= time_ns:
            at, topic, data = self._left.pop()
            self._writer.add_message(self._channels[topic], at, data, at)


def _said(events: Sequence[Event], log: Log) -> Iterator[tuple[int, str, bytes]]:
    """Time [ns], topic and content of each message."""
    zero = round((log.epoch_s or 0.0) * NS)
    first, last = (zero + round(float(log.time[i]) * NS) for i in (0, -1))
    yield first, STATES, _states(log, ())
    result = moments(events, log)
    for moment in result:
        yield moment.time_ns, EVENTS, _text(moment)
        yield moment.time_ns, STATES, _states(log, moment.open)
    if last > max((moment.time_ns for moment in result), default=first):
        yield last, STATES, _states(log, result[-1].open if result else ())


def _text(moment: Moment) -> bytes:
    from foxglove.messages import Log as LogMessage
    from foxglove.messages import LogLevel, Timestamp

    message = LogMessage(
        timestamp=Timestamp(sec=moment.time_ns // NS, nsec=moment.time_ns % NS),
        level=LogLevel.Error if moment.begins else LogLevel.Info,
        message=sentence(moment.event, moment.begins),
        name=moment.event.sensor or "",
    )
    return bytes(message.encode())


def _states(log: Log, open: Sequence[Event]) -> bytes:
    """Sensor -> `ok`, or the kind of the first of its ongoing faults."""
    state = dict.fromkeys(_names(log), _OK)
    for event in reversed(open):
        state["motion" if event.subject == "motion" else event.sensor or "unknown"] = event.kind
    return json.dumps(state).encode()


def _names(log: Log) -> list[str]:
    return [*(sensor.name for sensor in log.sensors), "motion", "unknown"]


def _schema(log: Log) -> bytes:
    fields = {name: {"type": "string"} for name in _names(log)}
    return json.dumps({"type": "object", "properties": fields}).encode()
