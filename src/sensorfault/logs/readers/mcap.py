"""MCAP recordings (`.mcap`), read from front to back: one that was not closed reads as well."""

import json
import struct
from io import BytesIO
from pathlib import Path
from typing import Any

from sensorfault.logs.readers.bag2 import parts_of
from sensorfault.logs.readers.decoded import Recording
from sensorfault.logs.readers.protobuf import protobuf_decoder
from sensorfault.logs.readers.ros_types import Decoder, decoder
from sensorfault.logs.readers.source import Ask, Damage, Tables
from sensorfault.logs.readers.telling import TellingFile
from sensorfault.logs.table import LogError

_MAGIC = b"\x89MCAP0\r\n"
_BROKEN = (struct.error, ValueError, OverflowError, MemoryError)  # what mcap raises beside its own
_LARGEST = 1 << 30  # no chunk is larger, and no record that is larger than its file


def read_mcap(path: Path, ask: Ask) -> Tables:
    """Every topic of ROS messages, protocol buffers or JSON that holds numbers.

    Raises:
        LogError: empty, no MCAP, or no topic with numbers in it.
    """
    recording = Recording(path, ask)
    for part in parts_of(path):
        with TellingFile(part, ask.tell) as file:
            head = file.read(len(_MAGIC))
            if head != _MAGIC:
                what = "an empty file" if not head else "no MCAP"
                raise LogError(f"{part}: this is {what}; name a .mcap file as its recorder wrote it.")
            _records(file, part, recording)
    return recording.tables()


def _records(file: TellingFile, path: Path, recording: Recording) -> None:
    """Every record of the data, to their end or the first that does not fit."""
    from mcap.exceptions import McapError
    from mcap.records import Channel, Chunk, DataEnd, Message, Schema
    from mcap.stream_reader import StreamReader

    schemas: dict[int, Any] = {}

    def take(record: Any, start: int) -> None:
        if isinstance(record, Message):
            if not recording.take((path, record.channel_id), record.log_time, record.data):
                recording.cannot_decode(f"byte {start}")
        elif isinstance(record, Schema):
            schemas[record.id] = record
        elif isinstance(record, Channel):
            _open(record, schemas.get(record.schema_id), path, recording)

    reader = StreamReader(file, skip_magic=True, emit_chunks=True, record_size_limit=max(_LARGEST, path.stat().st_size))
    records, start = reader.records, file.tell()
    while True:
        try:
            record = next(records, None)
        except (McapError, *_BROKEN):
            record = None
        if record is None or file.short is not None:
            for one in _cut_chunk(file, start):
                take(one, start)
            recording.damage.append(Damage("the recording breaks off, or holds what is no record,", f"byte {start}"))
            return
        if isinstance(record, DataEnd):
            return
        for one in _chunk(record, recording, f"byte {start}") if isinstance(record, Chunk) else [record]:
            take(one, start)
        start = file.tell()


def _chunk(chunk: Any, recording: Recording, where: str) -> list[Any]:
    """The records in a chunk."""
    from mcap.stream_reader import breakup_chunk

    try:
        if chunk.uncompressed_size > _LARGEST:
            raise ValueError(chunk.uncompressed_size)
        return breakup_chunk(chunk, validate_crc=True)
    except Exception:  # each compression fails in its own way
        recording.cannot_unpack(where)
        return []


def _cut_chunk(file: TellingFile, start: int) -> list[Any]:
    """The whole records of an uncompressed chunk that the end of the file cuts."""
    from mcap.data_stream import ReadDataStream
    from mcap.exceptions import McapError
    from mcap.opcode import Opcode
    from mcap.records import Chunk
    from mcap.stream_reader import StreamReader

    file.seek(start)
    found: list[Any] = []
    try:
        if file.read(9)[:1] == bytes([Opcode.CHUNK]):
            chunk = Chunk.read(ReadDataStream(file))
            inside = b"" if chunk.compression else chunk.data
            for record in StreamReader(BytesIO(inside), skip_magic=True, record_size_limit=len(inside)).records:
                found.append(record)  # noqa: PERF402  # what came before an error counts
    except (McapError, *_BROKEN):
        pass  # that and where the file is cut, its reader says
    return found[:-1]  # the last may be half of one


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
