"""Which reader opens which file."""

from collections.abc import Callable
from pathlib import Path

from sensorfault.logs.readers.csv import read_csv
from sensorfault.logs.readers.npy import read_npy
from sensorfault.logs.readers.parquet import read_parquet
from sensorfault.logs.readers.rtklib import read_pos
from sensorfault.logs.readers.source import Source
from sensorfault.logs.table import LogError

READERS: dict[str, Callable[[Path], Source]] = {
    ".csv": read_csv,
    ".tsv": read_csv,
    ".txt": read_csv,
    ".dat": read_csv,
    ".parquet": read_parquet,
    ".pos": read_pos,
    ".npy": read_npy,
}


def read_source(path: Path) -> Source:
    """One file's columns.

    Raises:
        LogError: no such file, no reader for its suffix, or the reader cannot read it.
    """
    if not path.exists():
        raise LogError(f"{path}: there is no such file; look at the path.")
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        raise LogError(f"{path}: nothing here reads '{path.suffix or path.name}'; give one of {', '.join(READERS)}.")
    try:
        return reader(path)
    except OSError as error:
        raise LogError(f"{path}: cannot be read ({error.strerror or error}); look at the file's rights.") from None
