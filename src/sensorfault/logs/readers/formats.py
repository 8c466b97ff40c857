"""Which reader opens which file. A reader registers its own format: see registry.py."""

from dataclasses import replace
from pathlib import Path
from zipfile import is_zipfile

import numpy as np

from sensorfault.core.extras import sentence_of_missing
from sensorfault.logs.readers.attitude import with_attitude
from sensorfault.logs.readers.autopilot_columns import with_columns
from sensorfault.logs.readers.format import Format
from sensorfault.logs.readers.gzipped import ZIP, head_of, is_packed, read_unpacked
from sensorfault.logs.readers.registry import registered, suffixes
from sensorfault.logs.readers.source import ALL, Ask, Source, Tables
from sensorfault.logs.table import LogError

_HEAD_BYTES = 4096
_ARCHIVES = (".tar", ".tar.gz", ".tgz", ".tar.bz2", ".tar.xz", ".zip", ".7z", ".rar")


def format_of(path: Path) -> Format | None:
    """The format of a file, by its name and, where several formats share that, its beginning.

    A format that recognises the beginning wins, then one that does not look at it; `Format.priority` decides a tie.

    Raises:
        OSError: the beginning is needed and cannot be read.
    """
    named = [one for one in registered() if one.may_be(path)]
    if len(named) < 2:
        return named[0] if named else None
    head = head_of(path, _HEAD_BYTES)
    sure = [one for one in named if one.looks is not None and one.looks(head)]
    return next(iter([*sure, *(one for one in named if one.looks is None), *named]))


def known_format(path: Path) -> Format:
    """The format of a file.

    Raises:
        LogError: no format has files of this name.
    """
    form = format_of(path)
    if form is not None:
        return form
    if path.suffix.lower() == ZIP and not is_zipfile(path):
        raise LogError(f"{path}: this zip is damaged, or none; pack the log again.")
    if path.name.lower().endswith(_ARCHIVES):
        raise LogError(
            f"{path}: this is an archive of several files; unpack it, and name a log in it or a drive's folder."
        )
    raise LogError(f"{path}: nothing here reads '{path.suffix or path.name}'; give one of {', '.join(suffixes())}.")


def read_source(path: Path, table: str | None = None) -> Source:
    """One table's columns; `table` says which, where the file holds several.

    Raises:
        LogError: no such file or table, no reader for its name, or the reader cannot read it.
    """
    return take_table(path, read_tables(path, Ask(None if table is None else frozenset({table}))), table)


def take_table(path: Path, tables: Tables, table: str | None) -> Source:
    """One of the tables that were read from a file.

    Raises:
        LogError: no such table, or several tables and no name.
    """
    if table is None and len(tables) == 1:
        return next(iter(tables.values()))
    if table in tables:
        return tables[table]
    named = ", ".join(name for name in read_tables(path) if name)
    if not named:
        raise LogError(f"{path}: this file is one table; remove the key 'table' from vehicle.toml.")
    what = "it holds several tables" if table is None else f"there is no table '{table}' in it"
    raise LogError(f'{path}: {what}; write table = "..." with one of {named}.')


@np.errstate(over="ignore", invalid="ignore")  # of numbers as damage makes them
def read_tables(path: Path, ask: Ask = ALL) -> Tables:
    """The requested tables of a file that are there; the only table of a file has no name.

    Raises:
        LogError: no such file, no reader for its name, the reader cannot read it, or it needs an extra.
    """
    if not path.exists():
        raise LogError(f"{path}: there is no such file; check the path.")
    try:
        form = known_format(path)
        part = ask.part
        asked = replace(ask, part=lambda tables: part(_finished(tables))) if part is not None else ask
        tables = read_unpacked(path, lambda file: form.read(file, asked)) if is_packed(path) else form.read(path, asked)
    except OSError as error:
        raise LogError(f"{path}: cannot be read ({error.strerror or error}); check the file's permissions.") from None
    except ImportError as error:  # the other files of a folder can be read all the same
        sentence = sentence_of_missing(error, f"{path}: reading it")
        if sentence is None:
            raise
        raise LogError(sentence) from None
    return _finished(tables)


def _finished(tables: Tables) -> Tables:
    """Each table with its name, the angles of its quaternion, and what else follows from an autopilot's columns."""
    return {name: with_columns(with_attitude(replace(source, table=name))) for name, source in tables.items()}
