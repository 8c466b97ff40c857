"""MCAP recordings (`.mcap`), read from front to back: one that was not closed reads as well."""

import json
from pathlib import Path
from typing import Any

from sensorfault.logs.readers.bag2 import first_part, parts_of
from sensorfault.logs.readers.decoded import Recording
from sensorfault.logs.readers.format import Format, remembering
from sensorfault.logs.readers.mcap_records import MAGIC, records
from sensorfault.logs.readers.protobuf import protobuf_decoder
from sensorfault.logs.readers.ros_types import Decoder, decoder
from sensorfault.logs.readers.source import Ask, Damage, Tables
from sensorfault.logs.readers.telling import TellingFile
from sensorfault.logs.table import LogError


def read_mcap(path: Path, ask: Ask) -> Tables:
    """Every topic of ROS messages, protocol buffers or JSON that holds numbers.

    Raises:
        LogError: empty, no MCAP, or no topic with numbers in it.
    """
    recording = Recording(path, ask)
    for part in parts_of(path):
        with TellingFile(part, ask.tell) as file:
            head = file.read(len(MAGIC))
            if head != MAGIC:
                what = "an empty file" if not head else "no MCAP"
                raise LogError(f"{part}: this is {what}; name a .mcap file as its recorder wrote it.")
            _records(file, part, recording)
    return recording.tables()


def _records(file: TellingFile, path: Path, recording: Recording) -> None:
    from mcap.records import Channel, Message, Schema

    def breaks_off(where: str) -> None:
        recording.damage.append(Damage("the recording breaks off, or holds what is no record,", where))

    schemas: dict[int, Any] = {}
    for record, start in records(file, path.stat().st_size, breaks_off, recording.cannot_unpack):
        if isinstance(record, Message):
            if not recording.take((path, record.channel_id), record.log_time, record.data):
                recording.cannot_decode(f"byte {start}")
        elif isinstance(record, Schema):
            schemas[record.id] = record
        elif isinstance(record, Channel):
            _open(record, schemas.get(record.schema_id), path, recording)


def _open(channel: Any, schema: Any, path: Path, recording: Recording) -> None:
    kind = schema.name if schema is not None and schema.name else "no type"
    decode = _decoder(channel.message_encoding, schema)
    said = kind if decode is not None else f"{kind}, {channel.message_encoding or 'no encoding'}"
    recording.open((path, channel.id), channel.topic, said, decode)


def _decoder(encoding: str, schema: Any) -> Decoder | None:
    if encoding == "json":
        return json.loads
    if encoding in ("cdr", "ros1") and schema is not None:
        text = schema.data.decode("utf-8", "replace")
        return decoder(schema.name, text, 1 if encoding == "ros1" else 2, idl=schema.encoding == "ros2idl")
    if encoding == "protobuf" and schema is not None:
        return protobuf_decoder(schema.name, schema.data)
    return None


FORMAT = Format("MCAP", ("*.mcap",), remembering(read_mcap), leader=first_part, parts=True)
