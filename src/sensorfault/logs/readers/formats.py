"""Which reader opens which file."""

from collections.abc import Callable
from pathlib import Path

from sensorfault.logs.readers.attitude import with_attitude
from sensorfault.logs.readers.csv import read_csv
from sensorfault.logs.readers.dataflash import read_dataflash
from sensorfault.logs.readers.mat import read_mat
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

# Formats whose files hold several tables, each with a clock of its own.
OF_TABLES: dict[str, Callable[[Path], dict[str, Source]]] = {".mat": read_mat, ".bin": read_dataflash}
SUFFIXES = (*READERS, *OF_TABLES)


def read_source(path: Path, table: str | None = None) -> Source:
    """One table's columns; `table` says which, where the file holds several.

    Raises:
        LogError: no such file or table, no reader for its suffix, or the reader cannot read it.
    """
    tables = read_tables(path)
    if table is None and len(tables) == 1:
        return next(iter(tables.values()))
    if table not in tables:
        named = ", ".join(name for name in tables if name)
        if not named:
            raise LogError(f"{path}: this file is one table; take the key 'table' out of vehicle.toml.")
        what = "it holds several tables" if table is None else f"there is no table '{table}' in it"
        raise LogError(f'{path}: {what}; write table = "..." with one of {named}.')
    return tables[table]


def read_tables(path: Path) -> dict[str, Source]:
    """Every table of a file; of a format with one table a file it has no name.

    Raises:
        LogError: no such file, no reader for its suffix, or the reader cannot read it.
    """
    if not path.exists():
        raise LogError(f"{path}: there is no such file; look at the path.")
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise LogError(f"{path}: nothing here reads '{path.suffix or path.name}'; give one of {', '.join(SUFFIXES)}.")
    try:
        tables = OF_TABLES[suffix](path) if suffix in OF_TABLES else {"": READERS[suffix](path)}
    except OSError as error:
        raise LogError(f"{path}: cannot be read ({error.strerror or error}); look at the file's rights.") from None
    return {name: with_attitude(source) for name, source in tables.items()}
