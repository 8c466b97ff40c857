"""UTIAS MRCLAM measurements: ranges and bearings to others, several at one time; each other becomes columns of its own.

Source: K. Y. K. Leung et al., The UTIAS multi-robot cooperative localization and mapping dataset, IJRR 30(8), 2011.
"""

from pathlib import Path

import numpy as np
import polars as pl

from sensorfault.logs.entries import ChannelEntry, SensorEntry
from sensorfault.logs.readers.csv import read_csv
from sensorfault.logs.readers.format import Format, one_table
from sensorfault.logs.readers.source import Source
from sensorfault.logs.table import LogError

_WIDTH = 4


def read_utias(path: Path) -> Source:
    """Columns `range_14` [m] and `bearing_14` [rad] for each barcode, as one sensor `barcode_14`.

    Raises:
        LogError: not the table that its comment says.
    """
    plain = read_csv(path)
    if plain.frame.width != _WIDTH:
        raise LogError(
            f"{path}: {plain.frame.width} columns where time, barcode, range and bearing should be; mend it."
        )
    time, code, distance, bearing = (plain.column(name).cast(pl.Float64).to_numpy() for name in plain.frame.columns)
    known = np.isfinite(time) & np.isfinite(code)
    if not known.any():
        raise LogError(f"{path}: no row has a time and a barcode; name a file with measurements.")
    ticks, at = np.unique(time[known], return_inverse=True)
    columns, sensors = {"time": ticks}, []
    for one in np.unique(code[known]):
        mine = code[known] == one
        names = (f"range_{one:.0f}", f"bearing_{one:.0f}")
        for name, value in zip(names, (distance, bearing), strict=True):
            columns[name] = np.full(len(ticks), np.nan)
            columns[name][at[mine]] = value[known][mine]
        channels = (
            ChannelEntry("range", names[0], "m", watch=False),
            ChannelEntry("bearing", names[1], "rad", watch=False),
        )
        sensors.append(
            SensorEntry(f"barcode_{one:.0f}", channels, why="another robot or a landmark, seen now and then")
        )
    return Source(path, pl.DataFrame(columns), "time", "s", 0, plain.notes, plain.damage, tuple(sensors))


def looks_utias(head: bytes) -> bool:
    """Whether a file that begins so is one."""
    return head.startswith(b"# UTIAS Multi-Robot") and b"Measurement Data" in head


FORMAT = Format("UTIAS measurements", ("*.dat",), one_table(read_utias), looks_utias, priority=1)
