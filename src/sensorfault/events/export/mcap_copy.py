"""Copy a recording, as far as it can be read."""

from collections.abc import Callable, Hashable
from pathlib import Path
from typing import Any

from sensorfault.logs.readers.bag2 import parts_of
from sensorfault.logs.readers.mcap_records import MAGIC, records
from sensorfault.logs.readers.telling import TellingFile


def profile_of(source: Path) -> str:
    """The profile in the recording's header, such as `ros2`."""
    from mcap.records import Header

    first = next(_whole(source), None)
    return str(first.profile) if isinstance(first, Header) else ""


def copy(source: Path, writer: Any, before: Callable[[int], None]) -> None:
    """Copy all files of a recording; `before` is called with each message's time [ns] before it is written."""
    known: dict[Hashable, int] = {}
    for part in parts_of(source):
        _copy(part, writer, before, known)


def _copy(part: Path, writer: Any, before: Callable[[int], None], known: dict[Hashable, int]) -> None:
    """Copy messages with all their times, attachments and metadata; `known`: schemas and channels written so far."""
    from mcap.records import Attachment, Channel, Message, Metadata, Schema

    def once(register: Callable[..., int], *about: Any) -> int:
        key = (register, *(tuple(sorted(one.items())) if isinstance(one, dict) else one for one in about))
        if key not in known:
            known[key] = register(*about)
        return known[key]

    schemas, channels = {0: 0}, dict[int, int]()
    for record in _whole(part):
        if isinstance(record, Message):
            if record.channel_id in channels:
                before(record.log_time)
                number = channels[record.channel_id]
                writer.add_message(number, record.log_time, record.data, record.publish_time, record.sequence)
        elif isinstance(record, Schema):
            schemas[record.id] = once(writer.register_schema, record.name, record.encoding, record.data)
        elif isinstance(record, Channel):
            if record.schema_id in schemas:
                kind = record.message_encoding, schemas[record.schema_id], record.metadata
                channels[record.id] = once(writer.register_channel, record.topic, *kind)
        elif isinstance(record, Attachment):
            one = record
            writer.add_attachment(one.create_time, one.log_time, one.name, one.media_type, one.data)
        elif isinstance(record, Metadata):
            writer.add_metadata(record.name, record.metadata)


def _whole(source: Path) -> Any:
    """The records that can be read. Damage was reported when the log was read."""
    with TellingFile(source, lambda share: None) as file:
        file.seek(len(MAGIC))
        for record, _ in records(file, source.stat().st_size, lambda where: None, lambda where: None):
            yield record
