"""Which reader opens which file. A new format is one more line in FORMATS."""

from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from sensorfault.core.extras import sentence_of_missing
from sensorfault.logs.readers.attitude import with_attitude
from sensorfault.logs.readers.bag1 import read_bag1
from sensorfault.logs.readers.bag2 import first_part, read_bag2
from sensorfault.logs.readers.can_bus import read_can
from sensorfault.logs.readers.csv import read_csv, rest_of_csv
from sensorfault.logs.readers.dataflash import read_dataflash
from sensorfault.logs.readers.dataflash_text import looks_dataflash_text, read_dataflash_text
from sensorfault.logs.readers.format import Format, in_parts, one_table, remembering
from sensorfault.logs.readers.gnss.leader import observations_beside
from sensorfault.logs.readers.gnss.librsf import looks_librsf, read_librsf
from sensorfault.logs.readers.gnss.nmea import looks_nmea, read_nmea
from sensorfault.logs.readers.gnss.rinex import looks_rinex
from sensorfault.logs.readers.gnss.rinex_nav import read_places
from sensorfault.logs.readers.gnss.rinex_obs import read_obs
from sensorfault.logs.readers.gnss.smartloc import looks_smartloc, read_smartloc
from sensorfault.logs.readers.gnss.sp3 import read_sp3
from sensorfault.logs.readers.gnss.ubx import read_ubx
from sensorfault.logs.readers.gzipped import head_of, is_packed, read_unpacked
from sensorfault.logs.readers.mat import read_mat
from sensorfault.logs.readers.mavlink import read_tlog
from sensorfault.logs.readers.mcap import read_mcap
from sensorfault.logs.readers.mdf import looks_mdf, read_mdf
from sensorfault.logs.readers.npy import called_by, read_npy
from sensorfault.logs.readers.parquet import read_parquet, rest_of_parquet
from sensorfault.logs.readers.rtklib import read_pos
from sensorfault.logs.readers.source import ALL, Ask, Source, Tables
from sensorfault.logs.readers.times_apart import table_timed
from sensorfault.logs.readers.ulog import read_ulog
from sensorfault.logs.readers.utias import looks_utias, read_utias
from sensorfault.logs.table import LogError

_HEAD_BYTES = 4096
_ARCHIVES = (".tar", ".tar.gz", ".tgz", ".tar.bz2", ".tar.xz", ".zip", ".7z", ".rar")


FORMATS = (
    Format(
        "text table",
        ("*.csv", "*.tsv", "*.txt", "*.dat"),
        in_parts(read_csv, rest_of_csv),
        leader=table_timed,
        parts=True,
    ),
    Format("libRSF measurements", ("*.txt",), remembering(read_librsf), looks_librsf),
    Format("smartLoc measurements", ("*.csv",), remembering(read_smartloc), looks_smartloc),
    Format("UTIAS measurements", ("*.dat",), one_table(read_utias), looks_utias),
    Format("Parquet", ("*.parquet",), in_parts(read_parquet, rest_of_parquet), parts=True),
    Format("RTKLIB solution", ("*.pos",), one_table(read_pos)),
    Format("NumPy arrays", ("*.npy",), one_table(read_npy), leader=called_by),
    Format("MATLAB", ("*.mat",), remembering(read_mat)),
    Format("PX4 ULog", ("*.ulg", "*.ulog"), remembering(read_ulog), parts=True),
    Format("ROS 1 bag", ("*.bag",), remembering(read_bag1), parts=True),
    Format("ROS 2 bag", ("*.db3",), remembering(read_bag2), leader=first_part, parts=True),
    Format("MCAP", ("*.mcap",), remembering(read_mcap), leader=first_part, parts=True),
    Format("ArduPilot DataFlash", ("*.bin",), remembering(read_dataflash), parts=True),
    Format("ArduPilot DataFlash text", ("*.log",), remembering(read_dataflash_text), looks_dataflash_text, parts=True),
    Format("MAVLink telemetry", ("*.tlog",), remembering(read_tlog), parts=True),
    Format("MDF", ("*.mf4", "*.mdf", "*.dat"), remembering(read_mdf), looks_mdf, parts=True),
    Format("CAN recording", ("*.blf", "*.asc"), remembering(read_can), parts=True),
    Format("u-blox", ("*.ubx",), remembering(read_ubx)),
    Format("NMEA", ("*.nmea", "*.txt", "*.log"), remembering(read_nmea), looks_nmea),
    Format(
        "RINEX observations",
        ("*.obs", "*.rnx", "*.[0-9][0-9]o"),
        remembering(one_table(read_obs)),
        partial(looks_rinex, "O"),
    ),
    Format(
        "RINEX navigation",
        ("*.nav", "*.rnx", "*.[0-9][0-9][nglp]"),
        remembering(one_table(read_places)),
        partial(looks_rinex, "NG"),
        observations_beside,
    ),
    Format("SP3 orbits", ("*.sp3",), remembering(one_table(read_sp3)), leader=observations_beside),
)
SUFFIXES = tuple(dict.fromkeys(name.removeprefix("*") for one in FORMATS for name in one.names))


def format_of(path: Path) -> Format | None:
    """The format of a file, by its name and, where that does not tell, its beginning.

    Raises:
        OSError: the beginning is needed and cannot be read.
    """
    named = [one for one in FORMATS if one.may_be(path)]
    if len(named) < 2:
        return named[0] if named else None
    head = head_of(path, _HEAD_BYTES)
    sure = [one for one in named if one.looks is not None and one.looks(head)]
    return next(iter([*sure, *(one for one in named if one.looks is None), *named]))


def known_format(path: Path) -> Format:
    """The same.

    Raises:
        LogError: nothing reads a file of this name.
    """
    form = format_of(path)
    if form is not None:
        return form
    if path.name.lower().endswith(_ARCHIVES):
        raise LogError(
            f"{path}: this is an archive of several files; unpack it, and name a log in it or a drive's folder."
        )
    raise LogError(f"{path}: nothing here reads '{path.suffix or path.name}'; give one of {', '.join(SUFFIXES)}.")


def read_source(path: Path, table: str | None = None) -> Source:
    """One table's columns; `table` says which, where the file holds several.

    Raises:
        LogError: no such file or table, no reader for its name, or the reader cannot read it.
    """
    return take_table(path, read_tables(path, Ask(None if table is None else frozenset({table}))), table)


def take_table(path: Path, tables: Tables, table: str | None) -> Source:
    """One of the tables that were read from a file.

    Raises:
        LogError: no such table, or several and none is named.
    """
    if table is None and len(tables) == 1:
        return next(iter(tables.values()))
    if table in tables:
        return tables[table]
    named = ", ".join(name for name in read_tables(path) if name)
    if not named:
        raise LogError(f"{path}: this file is one table; take the key 'table' out of vehicle.toml.")
    what = "it holds several tables" if table is None else f"there is no table '{table}' in it"
    raise LogError(f'{path}: {what}; write table = "..." with one of {named}.')


@np.errstate(over="ignore", invalid="ignore")  # of numbers as damage makes them
def read_tables(path: Path, ask: Ask = ALL) -> Tables:
    """The tables of a file that are asked for and there; of a format with one table a file it has no name.

    Raises:
        LogError: no such file, no reader for its name, the reader cannot read it, or it needs an extra.
    """
    if not path.exists():
        raise LogError(f"{path}: there is no such file; look at the path.")
    try:
        form = known_format(path)
        part = ask.part
        asked = replace(ask, part=lambda tables: part(_finished(tables))) if part is not None else ask
        tables = read_unpacked(path, lambda file: form.read(file, asked)) if is_packed(path) else form.read(path, asked)
    except OSError as error:
        raise LogError(f"{path}: cannot be read ({error.strerror or error}); look at the file's rights.") from None
    except ImportError as error:  # the other files of a folder can be read all the same
        sentence = sentence_of_missing(error, f"{path}: reading it")
        if sentence is None:
            raise
        raise LogError(sentence) from None
    return _finished(tables)


def _finished(tables: Tables) -> Tables:
    """Each table with its name, and with what its columns say in another way."""
    return {name: with_attitude(replace(source, table=name)) for name, source in tables.items()}
