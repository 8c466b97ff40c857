"""A file that reports how far it has been read, and where a read returned too few bytes."""

import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

_BUFFER_BYTES = 1 << 20


class _Raw(io.FileIO):
    """Reports once per buffer, so that many small reads cost nothing."""

    def __init__(self, path: Path, tell: Callable[[float], None]) -> None:
        super().__init__(path, "r")
        self._size = max(path.stat().st_size, 1)
        self._tell = tell

    def readinto(self, buffer: Any, /) -> int | None:
        got = super().readinto(buffer)
        self._tell(min(1.0, self.tell() / self._size))
        return got


def open_telling(path: Path, tell: Callable[[float], None]) -> io.BufferedReader:
    """A file that reports how far it has been read, at no cost for small reads."""
    return io.BufferedReader(_Raw(path, tell), _BUFFER_BYTES)


class TellingFile(io.BufferedReader):
    """`short`: where the last read that got something, but less than it asked for, began; None if there was none."""

    def __init__(self, path: Path, tell: Callable[[float], None]) -> None:
        super().__init__(_Raw(path, tell), _BUFFER_BYTES)
        self._whole = path.stat().st_size
        self.short: int | None = None

    def read(self, size: int | None = -1, /) -> bytes:
        asks = size is not None and size > self._whole  # a damaged length must not fill the memory
        data = super().read(self._whole if asks else size)
        if size is not None and 0 < len(data) < size:
            self.short = self.tell() - len(data)
        return data
