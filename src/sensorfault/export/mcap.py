"""Events as annotations in an MCAP, by foxglove-sdk: a log of begins and ends, and the state of each sensor."""

import json
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from sensorfault.events import Event
from sensorfault.export.moments import NS, moments, sentence
from sensorfault.logs.table import Log

EVENTS, STATES = "/sensorfault/events", "/sensorfault/states"
_OK = "ok"


def write_mcap(events: Sequence[Event], log: Log, path: Path, source: Path | None) -> None:
    """The messages of `source`, and beside them two topics.

    `/sensorfault/events` (foxglove.Log) for the log panel; `/sensorfault/states` (JSON) has for each sensor, and for
    the vehicle's motion, `ok` or the kind of fault, at the beginning and whenever one changes: for state transitions.
    """
    import foxglove
    from foxglove.messages import Log as LogMessage
    from foxglove.messages import LogLevel, Timestamp

    context = foxglove.Context()
    with foxglove.open_mcap(path, allow_overwrite=True, context=context):
        if source is not None:
            _copy(source, context)
        texts = foxglove.Channel(EVENTS, schema=LogMessage.get_schema(), message_encoding="protobuf", context=context)
        states = foxglove.Channel(STATES, schema=_schema(log), message_encoding="json", context=context)
        zero = round((log.epoch_s or 0.0) * NS)
        start = zero + round(float(log.time[0]) * NS)
        states.log(json.dumps(_states(log, ())).encode(), log_time=start)
        for moment in moments(events, log):
            message = LogMessage(
                timestamp=Timestamp(sec=moment.time_ns // NS, nsec=moment.time_ns % NS),
                level=LogLevel.Error if moment.begins else LogLevel.Info,
                message=sentence(moment.event, moment.begins),
                name=moment.event.sensor or "",
            )
            texts.log(message.encode(), log_time=moment.time_ns)
            states.log(json.dumps(_states(log, moment.open)).encode(), log_time=moment.time_ns)


def _states(log: Log, open: Sequence[Event]) -> dict[str, str]:
    """Sensor -> `ok` or the kind of the first of its faults that lasts."""
    state = {**{sensor.name: _OK for sensor in log.sensors}, "motion": _OK, "unknown": _OK}
    for event in reversed(open):
        state["motion" if event.subject == "motion" else event.sensor or "unknown"] = event.kind
    return state


def _schema(log: Log) -> Any:
    import foxglove

    fields = {name: {"type": "string"} for name in _states(log, ())}
    text = json.dumps({"type": "object", "properties": fields})
    return foxglove.Schema(name="sensorfault.States", encoding="jsonschema", data=text.encode())


def _copy(source: Path, context: Any) -> None:
    """Every message of a recording, as far as it is whole."""
    import foxglove

    channels: dict[int, Any] = {}
    for schema, channel, message in _messages(source):
        if channel.id not in channels:
            described = None
            if schema is not None:
                described = foxglove.Schema(name=schema.name, encoding=schema.encoding, data=schema.data)
            channels[channel.id] = foxglove.Channel(
                channel.topic,
                schema=described,
                message_encoding=channel.message_encoding,
                metadata=dict(channel.metadata),
                context=context,
            )
        channels[channel.id].log(message.data, log_time=message.log_time)


def _messages(source: Path) -> Iterator[Any]:
    import struct

    from mcap.exceptions import McapError
    from mcap.reader import NonSeekingReader

    with source.open("rb") as file:
        try:
            yield from NonSeekingReader(file).iter_messages(log_time_order=False)
        except (McapError, struct.error, ValueError):
            return  # reading the log has told where it ends
