"""A DataFlash file in pieces of whole messages, each indexed by pymavlink, which would index a file as a whole."""

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from pymavlink.DFReader import DFReader_binary

from sensorfault.logs.readers.quiet import quiet

PIECE_BYTES = 1 << 24
_DESCRIPTION = 128  # the number of FMT, whose messages say what the others are like
_MEANING = ("UNIT", "MULT", "FMTU")  # messages that say what the numbers in others mean
_UNSEEN = 3  # a message that begins in the last bytes is not looked for: its head does not fit


class BadDescription(Exception):
    """What kinds of messages there are is said in a way that nobody understands. `at`: a byte before it."""

    def __init__(self, at: int, reason: str) -> None:
        super().__init__(reason)
        self.at = at


@dataclass(frozen=True)
class Piece:
    """Bytes whose first would be the file's byte `at`; for each kind, where its whole messages begin in them."""

    at: int
    content: np.ndarray
    formats: dict[int, Any]
    starts: dict[int, np.ndarray]

    @property
    def end(self) -> int:
        """Byte of the file behind it."""
        return self.at + len(self.content)


def pieces_of(path: Path) -> Iterator[Piece]:
    """All messages of a file, piece by piece.

    Raises:
        BadDescription: at the piece whose messages cannot be told apart.
    """
    size, start = path.stat().st_size, 0
    described: dict[bytes, None] = {}  # messages that later pieces need as well, the newest last
    meant: dict[bytes, None] = {}
    with path.open("rb") as file:
        while start < size:
            file.seek(start)
            head = b"".join((*described, *meant))
            content = head + file.read(PIECE_BYTES)
            piece, end = _piece(path, content, start, len(head))
            yield piece
            for number, form in piece.formats.items():
                if number == _DESCRIPTION or form.name in _MEANING:
                    kept = described if number == _DESCRIPTION else meant
                    for at in piece.starts[number].tolist():
                        message = content[at : at + form.len]
                        kept.pop(message, None)
                        kept[message] = None
            start = size if piece.end >= size else max(end, start + 1)


def _piece(path: Path, content: bytes, start: int, head: int) -> tuple[Piece, int]:
    """The messages behind the head, and where in the file the next piece begins."""
    try:
        with quiet():
            index = _Index(path, content)
    except Exception as error:  # a damaged log fails in as many ways as it can be damaged
        raise BadDescription(start, (str(error).splitlines() or [type(error).__name__])[0].rstrip(".")) from None
    starts: dict[int, np.ndarray] = {}
    at, length = 0, 0  # of the last message
    for number, form in index.formats.items():
        found = np.asarray(index.offsets[number], np.int64)
        starts[number] = found[(found >= head) & (found + form.len <= len(content))]
        at, length = max((at, length), (int(found[-1]), form.len)) if len(found) else (at, length)
    # What is no message in the last bytes may be the beginning of one.
    end = at if at + length > len(content) else max(at + length, len(content) - _UNSEEN)
    return Piece(start - head, np.frombuffer(content, np.uint8), dict(index.formats), starts), start - head + end


class _Index(DFReader_binary):  # type: ignore[misc]
    """Where messages begin in bytes. `formats`, `offsets`: by a kind's number."""

    data_map: Any

    def __init__(self, path: Path, content: bytes) -> None:
        self._content = content
        try:
            super().__init__(str(path))
        finally:
            self.filehandle.close()

    def init_arrays(self, progress_callback: Any = None) -> None:
        self._narrow()
        super().init_arrays(progress_callback)

    def init_arrays_fast(self, progress_callback: Any = None) -> None:
        self._narrow()
        super().init_arrays_fast(progress_callback)

    def init_clock(self) -> None:
        """None: what time it was is for a vehicle file to say, and pymavlink may look through all for it."""

    def _narrow(self) -> None:
        self.data_map.close()
        self.data_map, self.data_len = self._content, len(self._content)
