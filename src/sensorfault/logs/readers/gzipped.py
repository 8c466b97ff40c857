"""Files packed by gzip, or alone in a zip: unpacked to a temporary folder and read as their own format."""

import os
import re
import tempfile
import zipfile
import zlib
from collections.abc import Callable
from dataclasses import dataclass, replace
from io import BufferedIOBase, BytesIO
from pathlib import Path

from sensorfault.logs.readers.source import Damage, Source, Tables, with_notes
from sensorfault.logs.table import LogError

SUFFIX, ZIP = ".gz", ".zip"
_CHUNK = 1 << 16
_UNKNOWN_MEMORY = 8 * 10**9
_EXTRA = re.compile(r"__MACOSX/|.*\.DS_Store$")  # what a system adds by itself
_GZIP = 31  # zlib's number for 32 kB of window and gzip's own head and tail


class TooLarge(Exception):
    """What is packed is larger than may be unpacked."""


@dataclass
class Most:
    """How many bytes may be unpacked of one file; None: as many as this machine has memory."""

    size: int | None = None

    @property
    def bytes(self) -> int:
        """In bytes."""
        if self.size is not None:
            return self.size
        try:
            return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
        except (AttributeError, OSError, ValueError):
            return _UNKNOWN_MEMORY


most = Most()


def is_packed(path: Path) -> bool:
    """Whether its name says so; a zip must hold one file only."""
    return path.suffix.lower() == SUFFIX or _alone(path) is not None


def inner(path: Path) -> Path:
    """What a file is called when it is unpacked."""
    if path.suffix.lower() == SUFFIX:
        return path.with_suffix("")
    alone = _alone(path)
    return path.with_name(Path(alone).name) if alone is not None else path


def _alone(path: Path) -> str | None:
    """The only file in a zip; None if it is no zip, or holds several."""
    if path.suffix.lower() != ZIP or not path.is_file():
        return None
    try:
        with zipfile.ZipFile(path) as packed:
            names = [one.filename for one in packed.infolist() if not one.is_dir() and not _EXTRA.match(one.filename)]
    except (zipfile.BadZipFile, OSError):
        return None
    return names[0] if len(names) == 1 else None


def head_of(path: Path, size: int) -> bytes:
    """The first bytes of a file, or as many as can be read, of what is packed in it if it is."""
    if not is_packed(path):
        with path.open("rb") as file:
            return file.read(size)
    plain = BytesIO()
    _unpack(path, plain, size)
    return plain.getvalue()[:size]


def read_unpacked(path: Path, read: Callable[[Path], Tables]) -> Tables:
    """The tables of a packed file. One that breaks off is read as far as it can be unpacked.

    Raises:
        LogError: not packed by gzip, or what the reader says of what is in it.
    """
    damage = []
    with tempfile.TemporaryDirectory(prefix="sensorfault-") as folder:
        file = Path(folder) / inner(path).name
        with file.open("wb") as plain:
            try:
                whole = _unpack(path, plain)
            except TooLarge:
                raise LogError(
                    f"{path}: unpacked it is larger than {most.bytes / 1e9:.3g} GB, the most that may be unpacked; "
                    "unpack it yourself, or allow more with --max-size."
                ) from None
            if not plain.tell():
                raise LogError(f"{path}: this file cannot be unpacked; pack the log again.")
            if not whole:
                damage.append(Damage("the packed file is damaged or breaks off", f"unpacked byte {plain.tell()}"))
        try:
            tables = read(file)
        except LogError as error:
            raise LogError(str(error).replace(str(file), str(path))) from None
    own = {name: _of_packed(source, path) for name, source in tables.items()}
    return with_notes(own, (), damage)


def _of_packed(source: Source, path: Path) -> Source:
    """The table as one of the packed file. Lines that are looked for in the unpacked one are not known any more."""
    return replace(source, path=path) if source.lines is None else replace(source, path=path, lines=None, first_line=0)


def _unpack(path: Path, plain: BufferedIOBase, head: int | None = None) -> bool:
    """Unpack as far as it goes, or until `head` bytes; whether all of it is sound.

    Python's own gzip gives nothing of the block in which the damage is.
    """
    if path.suffix.lower() == ZIP:
        return _unzip(path, plain, head)
    with path.open("rb") as packed:
        unpacker = zlib.decompressobj(_GZIP)
        while chunk := packed.read(_CHUNK):
            while chunk:
                before = unpacker.copy()
                try:
                    plain.write(unpacker.decompress(chunk))
                except zlib.error:
                    _byte_by_byte(before, chunk, plain)
                    return False
                chunk = unpacker.unused_data if unpacker.eof else b""
                if chunk:  # another file is packed behind it
                    unpacker = zlib.decompressobj(_GZIP)
            if head is not None and plain.tell() >= head:
                return True
            if plain.tell() > most.bytes:
                raise TooLarge
        return unpacker.eof


def _unzip(path: Path, plain: BufferedIOBase, head: int | None) -> bool:
    name = _alone(path)
    assert name is not None
    try:
        with zipfile.ZipFile(path) as packed, packed.open(name) as file:
            while chunk := file.read(_CHUNK):
                plain.write(chunk)
                if head is not None and plain.tell() >= head:
                    break
                if plain.tell() > most.bytes:
                    raise TooLarge
    except (zipfile.BadZipFile, zlib.error, EOFError, RuntimeError, NotImplementedError):  # damaged, or encrypted
        return False
    return True


def _byte_by_byte(unpacker: "zlib._Decompress", chunk: bytes, plain: BufferedIOBase) -> None:
    for i in range(len(chunk)):
        try:
            plain.write(unpacker.decompress(chunk[i : i + 1]))
        except zlib.error:
            return
