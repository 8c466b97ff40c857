"""The messages in a u-blox stream; after a damaged one the search continues at its next byte."""

import mmap
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

from sensorfault.logs.readers.source import Damage

_SYNC = b"\xb5\x62"
_AROUND = 8  # bytes of a message that are not its payload
_TELL_EVERY = 1 << 22


def frames(path: Path, lost: list[Damage], tell: Callable[[float], None]) -> Iterator[tuple[int, bytes]]:
    """Class and number (as 0xCCNN) and payload of each message whose checksum is right.

    Args:
        path: of the stream; what is not u-blox's in it (NMEA, RTCM) is passed over.
        lost: where damage is added to.
        tell: is called with the share that has been read.
    """
    if not path.stat().st_size:
        return
    with path.open("rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as stream:
        size, result = len(stream), 0
        broken: list[int] = []
        at = stream.find(_SYNC)
        while at >= 0:
            end = at + _AROUND + (int.from_bytes(stream[at + 4 : at + 6], "little") if at + 6 <= size else size)
            if end <= size and _checksum(stream[at + 2 : end - 2]) == stream[end - 2 : end]:
                yield int.from_bytes(stream[at + 2 : at + 4], "big"), stream[at + 6 : end - 2]
                at = stream.find(_SYNC, end)
            else:
                broken.append(at)
                at = stream.find(_SYNC, at + 1)
            if at - result > _TELL_EVERY:
                result = at
                tell(at / size)
        if broken:
            what = "a message is damaged or cut off"
            if len(broken) > 1:
                what = f"{len(broken)} messages are damaged or cut off, the first"
            lost.append(Damage(what, f"byte {broken[0]}", "all the others were read"))


def _checksum(body: bytes) -> bytes:
    """Fletcher's 8-bit sums over class, number, length and payload (interface description, 3.4)."""
    byte = np.frombuffer(body, np.uint8).astype(np.int64)
    # A = Σ bᵢ,  B = Σ (n - i) bᵢ
    a, b = int(byte.sum()), int((byte * np.arange(len(byte), 0, -1)).sum())
    return bytes((a & 255, b & 255))
