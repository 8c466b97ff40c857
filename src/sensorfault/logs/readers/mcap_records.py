"""The records of an MCAP from front to back, without damaged ones."""

import struct
from collections.abc import Callable, Iterator
from io import BytesIO
from typing import Any

from sensorfault.logs.readers.telling import TellingFile

MAGIC = b"\x89MCAP0\r\n"
_BROKEN = (struct.error, ValueError, OverflowError, MemoryError)  # what mcap raises beside its own
_LARGEST = 1 << 30  # no chunk is larger, and no record that is larger than its file
_Where = Callable[[str], None]


def records(file: TellingFile, size: int, breaks_off: _Where, cannot_unpack: _Where) -> Iterator[tuple[Any, int]]:
    """Every record behind the magic, those in chunks as well, and the byte at which it or its chunk begins.

    They end with the data, or with the first that does not fit.

    Args:
        file: behind the magic.
        size: of the file [bytes].
        breaks_off: is called with the place where the file breaks off, `byte 4711`.
        cannot_unpack: is called with the place of each chunk with a wrong compression or checksum; it is skipped.
    """
    from mcap.exceptions import McapError
    from mcap.records import Chunk, DataEnd
    from mcap.stream_reader import StreamReader

    reader = StreamReader(file, skip_magic=True, emit_chunks=True, record_size_limit=max(_LARGEST, size))
    each, start = reader.records, file.tell()
    while True:
        try:
            record = next(each, None)
        except (McapError, *_BROKEN):
            record = None
        if record is None or file.short is not None:
            for one in _cut_chunk(file, start):
                yield one, start
            breaks_off(f"byte {start}")
            return
        if isinstance(record, DataEnd):
            return
        if not isinstance(record, Chunk):
            yield record, start
        else:
            for one in _chunk(record, cannot_unpack, f"byte {start}"):
                yield one, start
        start = file.tell()


def _chunk(chunk: Any, cannot_unpack: _Where, where: str) -> list[Any]:
    """The records in a chunk."""
    from mcap.stream_reader import breakup_chunk

    try:
        if chunk.uncompressed_size > _LARGEST:
            raise ValueError(chunk.uncompressed_size)
        return breakup_chunk(chunk, validate_crc=True)
    except Exception:  # each compression fails in its own way
        cannot_unpack(where)
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
