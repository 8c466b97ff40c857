"""Files packed by gzip: unpacked beside nothing of the user's, read as what they are, called by their own name."""

import gzip
import shutil
import tempfile
import zlib
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

from sensorfault.logs.readers.source import Damage, Tables, told
from sensorfault.logs.table import LogError

SUFFIX = ".gz"


def is_packed(path: Path) -> bool:
    """Whether its name says so."""
    return path.suffix.lower() == SUFFIX


def inner(path: Path) -> Path:
    """What a file is called when it is unpacked."""
    return path.with_suffix("") if is_packed(path) else path


def head_of(path: Path, size: int) -> bytes:
    """The first bytes of a file, or as many as can be read, of what is packed in it if it is."""
    if not is_packed(path):
        with path.open("rb") as file:
            return file.read(size)
    try:
        with gzip.open(path) as file:
            return file.read(size)
    except (EOFError, zlib.error, gzip.BadGzipFile):
        return b""


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
                with gzip.open(path) as packed:
                    shutil.copyfileobj(packed, plain, 1 << 20)
            except (EOFError, zlib.error, gzip.BadGzipFile) as error:
                if not plain.tell():
                    raise LogError(
                        f"{path}: this cannot be unpacked ({error}); pack the log again with gzip."
                    ) from None
                reached = f"byte {plain.tell()} of what is packed"
                damage.append(Damage("the packed file is damaged or breaks off", reached))
        try:
            tables = read(file)
        except LogError as error:
            raise LogError(str(error).replace(str(file), str(path))) from None
    own = {name: replace(source, path=path) for name, source in tables.items()}
    return told(own, (), damage)
