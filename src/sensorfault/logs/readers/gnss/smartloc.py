"""smartLoc's raw measurements with truth and labels (`RXM-RAWX.csv`): one row for each satellite and epoch.

Source: P. Reisdorf et al., The problem of comparable GNSS results: an approach for a uniform dataset with low-cost and
reference data, ICWMC (2016); its columns say their units. `nlos` is 1 where a satellite was out of sight.
"""

from pathlib import Path

import numpy as np
import polars as pl

from sensorfault.logs.readers.csv import read_csv
from sensorfault.logs.readers.format import Format, remembering
from sensorfault.logs.readers.gnss.fixes import gnss_table
from sensorfault.logs.readers.gnss.observed import name_of, observed
from sensorfault.logs.readers.gps_time import unix_from_gps_week
from sensorfault.logs.readers.source import Ask, Source, Tables, with_notes
from sensorfault.logs.table import LogError
from sensorfault.numerics.gnss.constants import WEEK_S

_SYSTEMS = {"gps": "G", "sbas": "S", "glonass": "R", "galileo": "E", "beidou": "C", "qzss": "J"}
_VALUES = {
    "pseudorange_m": "(prMes)",
    "doppler_hz": "(doMes)",
    "cn0_dbhz": "(cno)",
    "sigma_m": "(prStdev)",
    "nlos": "NLOS",
}
_TRUTH = {"longitude": "(GT Lon)", "latitude": "(GT Lat)", "altitude": "(GT Height)", "speed": "(GT Velocity)"}
RANGES, TRUTH = "RXM-RAWX", "truth"


def read_smartloc(path: Path, ask: Ask) -> Tables:
    """Table `RXM-RAWX`: pseudorange, Doppler, C/N0 and label of each satellite; `truth`: where the car was.

    Raises:
        LogError: not the table that it is called, or a cell that is no number where one must be.
    """
    source = read_csv(path)
    time = _column(source, "(week)") * WEEK_S + _column(source, "(rcvTow)")
    system = [_SYSTEMS.get(str(one).strip().lower(), "X") for one in source.frame[_called(source, "(gnssId)")]]
    number = _column(source, "(svId)")
    whole = np.isfinite(time) & np.isfinite(number)
    epochs, epoch = np.unique(time[whole], return_inverse=True)
    if not len(epochs):
        raise LogError(f"{path}: no row has a time and a satellite; name smartLoc's RXM-RAWX.csv as it came.")
    names: dict[str, int] = {}
    whom = [names.setdefault(name_of(system[i], int(number[i])), len(names)) for i in np.flatnonzero(whole)]
    values = {name: _column(source, mark)[whole].tolist() for name, mark in _VALUES.items()}
    tables: Tables = {}
    if ask.wants(RANGES):
        tables[RANGES] = observed(epochs.tolist(), list(names), epoch.tolist(), whom, values).table(path)
    if ask.wants(TRUTH):
        first = np.flatnonzero(whole)[np.unique(epoch, return_index=True)[1]]
        zero = unix_from_gps_week(0, float(epochs[0]))
        truth = {name: _column(source, mark)[first] for name, mark in _TRUTH.items()}
        tables[TRUTH] = gnss_table(path, {"time": zero + (epochs - epochs[0]), **truth})
    return with_notes(tables, source.notes, source.damage)


def _called(source: Source, mark: str) -> str:
    """The column whose name has the mark in it, and is not of its spread."""
    found = [name for name in source.frame.columns if mark in name and " Cov " not in name]
    if not found:
        raise LogError(f"{source.path}: there is no column with '{mark}' in its name; name smartLoc's RXM-RAWX.csv.")
    return found[0]


def _column(source: Source, mark: str) -> np.ndarray:
    """A column as numbers, NaN where it says '#', no information."""
    column = source.frame[_called(source, mark)]
    if not column.dtype.is_numeric():
        column = column.cast(pl.String).str.strip_chars().cast(pl.Float64, strict=False)
    numbers: np.ndarray = column.cast(pl.Float64).fill_null(float("nan")).to_numpy()
    return numbers


def looks_smartloc(head: bytes) -> bool:
    """Whether a file that begins so is one."""
    return head.startswith(b"GPSWeek [weeks];") and b"(prMes)" in head


FORMAT = Format("smartLoc measurements", ("*.csv",), remembering(read_smartloc), looks_smartloc)
