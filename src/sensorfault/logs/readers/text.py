"""The bytes of a text file as lines: encoding, line ends, and how much of the beginning shows what it is."""

import codecs
from dataclasses import dataclass
from pathlib import Path

from sensorfault.logs.table import LogError

_CONTROLS = bytes(byte for byte in range(32) if not 9 <= byte <= 13)
_HEAD_BYTES = 1 << 16
_MOST_BYTES = 1 << 24
_LINES = 50  # that a beginning should have
_WIDE = {codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16"}


@dataclass(frozen=True)
class Text:
    """The beginning of a text file. `wide`: in UTF-16. `old`: its lines end with a carriage return alone."""

    lines: tuple[str, ...]
    wide: bool
    old: bool

    @property
    def plain(self) -> bool:
        """Whether its bytes are in UTF-8, or nearly, with a line feed behind each line."""
        return not (self.wide or self.old)


def beginning(path: Path) -> Text:
    """The first 64 kB of a file, or more where its lines are long.

    Raises:
        LogError: empty, or not text.
    """
    with path.open("rb") as file:
        head = file.read(_HEAD_BYTES)
        while len(head) < _MOST_BYTES and (more := file.read(3 * len(head))):
            if head.count(b"\n") + head.count(b"\r") >= _LINES:
                break
            head += more
        whole = not file.read(1)
    if not head.strip():
        raise LogError(f"{path}: the file is empty; name a log with a header and rows.")
    wide = head[:2] in _WIDE
    plain = head.translate(None, _CONTROLS)
    if not wide and (b"\0" in head or len(head) - len(plain) > len(head) // 100):
        raise LogError(f"{path}: this is not text although its name says so; export the log as CSV or Parquet.")
    text = _decoded(head)
    old = "\n" not in text and "\r" in text
    lines = [line.removesuffix("\r") for line in text.split("\r" if old else "\n")]
    if len(lines) > 1 and not (whole and lines[-1]):
        lines.pop()  # cut by us, or nothing behind the last end of a line
    return Text(tuple(lines), wide, old)


def plain_bytes(path: Path, text: Text) -> bytes:
    """The whole file in UTF-8 with line feeds."""
    content = path.read_bytes()
    if text.wide:
        content = content.decode("utf-16", "replace").encode()
    return content.replace(b"\r\n", b"\n").replace(b"\r", b"\n") if text.old else content


def _decoded(head: bytes) -> str:
    if head[:2] in _WIDE:
        return head[: len(head) // 2 * 2].decode("utf-16", "replace")
    try:
        return codecs.getincrementaldecoder("utf-8-sig")().decode(head)  # the end may be in the middle of a letter
    except UnicodeDecodeError:
        return head.decode("cp1252", "replace")
