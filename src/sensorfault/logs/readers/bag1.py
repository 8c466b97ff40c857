"""ROS 1 bags (`.bag`), read from front to back: one without an index, because its recorder died, reads as well."""

from io import BufferedIOBase, BytesIO
from pathlib import Path
from typing import Any

from sensorfault.logs.readers.decoded import Recording
from sensorfault.logs.readers.format import Format, remembering
from sensorfault.logs.readers.ros_types import decoder
from sensorfault.logs.readers.source import Ask, Damage, Tables
from sensorfault.logs.readers.telling import TellingFile
from sensorfault.logs.table import LogError

_MAGIC = b"#ROSBAG V2.0\n"
_NS = 10**9


def read_bag1(path: Path, ask: Ask) -> Tables:
    """Every topic that holds numbers.

    Raises:
        LogError: empty, not a bag of version 2.0, encrypted, or no topic with numbers in it.
    """
    with TellingFile(path, ask.tell) as file:
        head = file.read(len(_MAGIC))
        if head != _MAGIC:
            what = "an empty file" if not head else "no bag of ROS 1, version 2.0"
            raise LogError(f"{path}: this is {what}; name a .bag file as rosbag wrote it.")
        recording = Recording(path, ask)
        _records(file, path.stat().st_size, recording, "")
    return recording.tables()


class _Broken(Exception):
    """A record that does not fit. `header`, `data`: what is there of it, where the file ends within its data."""

    def __init__(self, header: Any = None, data: bytes = b"") -> None:
        self.header, self.data = header, data


def _records(file: BufferedIOBase, size: int, recording: Recording, within: str) -> None:
    """Every record to the end or the first that does not fit. `within`: where the chunk that they are in begins."""
    from rosbags.rosbag1.reader import Header, ReaderError, RecordType

    while (start := file.tell()) < size:
        where = within or f"byte {start}"
        try:
            header, data = _record(file, size, Header)
            kind = header.get_uint8("op")
            if kind == RecordType.CHUNK and not within:
                _chunk(header.get_string("compression"), data, recording, where)
            elif kind == RecordType.CONNECTION:
                _connection(header, data, recording)
            elif kind == RecordType.MSGDATA and not recording.take(
                header.get_uint32("conn"), header.get_time("time"), data
            ):
                recording.cannot_decode(where)
        except (_Broken, ReaderError, UnicodeDecodeError) as broken:
            if isinstance(broken, _Broken) and broken.header and broken.header.get("compression") == b"none":
                _chunk("none", broken.data, recording, where)
            recording.damage.append(Damage("the bag breaks off, or holds what is no record,", where))
            return


def _record(file: BufferedIOBase, size: int, reader: Any) -> tuple[Any, bytes]:
    """Header, by rosbags' `reader` of headers, and data of one record."""
    words = file.read(4)
    length = int.from_bytes(words, "little")
    if len(words) < 4 or length > size - file.tell():
        raise _Broken
    header = reader.read(BytesIO(words + file.read(length)))
    words = file.read(4)
    length = int.from_bytes(words, "little")
    if len(words) < 4 or length > size - file.tell():
        raise _Broken(header, file.read())
    return header, file.read(length)


def _chunk(compression: str, data: bytes, recording: Recording, where: str) -> None:
    from rosbags.rosbag1.reader import decompressors

    try:
        plain = decompressors[compression](data)
    except Exception:  # each compression fails in its own way
        recording.cannot_unpack(where)
        return
    _records(BytesIO(plain), len(plain), recording, where)


def _connection(header: Any, data: bytes, recording: Recording) -> None:
    from rosbags.rosbag1.reader import Header

    about = Header.read(BytesIO(len(data).to_bytes(4, "little") + data))
    topic, kind = header.get_string("topic"), about.get_string("type")
    recording.open(header.get_uint32("conn"), topic, kind, decoder(kind, about.get_string("message_definition"), ros=1))


FORMAT = Format("ROS 1 bag", ("*.bag",), remembering(read_bag1), parts=True)
