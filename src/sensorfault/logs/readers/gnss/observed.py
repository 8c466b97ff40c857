"""What a receiver measured of each satellite, epoch by epoch, and the table that is made of it."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import polars as pl
from jaxtyping import Float

from sensorfault.logs.entries import ChannelEntry, SensorEntry
from sensorfault.logs.readers.gps_time import unix_from_gps_week
from sensorfault.logs.readers.source import Damage, Source

TIME = "time"
UNITS = {  # the columns of one satellite, `G07.pseudorange_m`, in this order
    "pseudorange_m": "m",
    "corrected_m": "m",
    "doppler_hz": "Hz",
    "cn0_dbhz": "dB-Hz",
    "sigma_m": "m",
    "elevation_rad": "rad",
    "x_m": "m",
    "y_m": "m",
    "z_m": "m",
    "vx_m_s": "m/s",
    "vy_m_s": "m/s",
    "vz_m_s": "m/s",
    "clock_s": "s",
    "nlos": "",
}
WHY = "one satellite; its values are judged only by methods that know its position"


@dataclass(frozen=True)
class Observed:
    """T epochs of S satellites, NaN where nothing was received.

    `time`: of reception by the receiver's clock [s of GPS time]. `value`: by name as in UNITS. `frequency`:
    received of a system (`C`), where it is not its first [Hz].
    """

    time: Float[np.ndarray, " T"]
    satellites: tuple[str, ...]
    value: Mapping[str, Float[np.ndarray, "T S"]]
    frequency: Mapping[str, float] = field(default_factory=dict)

    def table(
        self,
        path: Path,
        notes: Iterable[str] = (),
        damage: Iterable[Damage] = (),
        gps_time: bool = True,
    ) -> Source:
        """One column for each satellite and value, on Unix time, or on its own clock if that is not GPS time."""
        zero = unix_from_gps_week(0, float(self.time[0])) if gps_time else float(self.time[0])
        columns = {TIME: zero + (self.time - self.time[0])}
        for i, satellite in enumerate(self.satellites):
            known = ((name, self.value[name][:, i]) for name in UNITS if name in self.value)
            columns |= {f"{satellite}.{name}": value for name, value in known if np.isfinite(value).any()}
        frame = pl.DataFrame({name: np.ascontiguousarray(column) for name, column in columns.items()})
        return Source(path, frame, TIME, "s", 0, tuple(notes), tuple(damage), satellite_sensors(frame.columns))


def observed(
    epochs: list[float],
    names: list[str],
    epoch: list[int],
    satellite: list[int],
    values: Mapping[str, list[float]],
    frequency: Mapping[str, float] | None = None,
) -> Observed:
    """Gather single measurements.

    Args:
        epochs: their times [s of GPS time].
        names: of the satellites.
        epoch: which one each measurement is of.
        satellite: which one each is of.
        values: by name as in UNITS, one for each measurement.
        frequency: as of `Observed`.
    """
    order = np.argsort(names, kind="stable")
    place = np.argsort(order)[np.array(satellite, int)]
    dense = {}
    for name, each in values.items():
        dense[name] = np.full((len(epochs), len(names)), np.nan)
        dense[name][np.array(epoch, int), place] = each
    return Observed(np.array(epochs), tuple(names[i] for i in order), dense, frequency or {})


def satellite_sensors(columns: Iterable[str]) -> tuple[SensorEntry, ...]:
    """One sensor for each satellite that has columns `G07.pseudorange_m` and so on; none of it is judged by itself."""
    of: dict[str, list[ChannelEntry]] = {}
    for column in columns:
        satellite, _, name = column.partition(".")
        if name in UNITS:
            of.setdefault(satellite, []).append(ChannelEntry(name, column, UNITS[name], watch=False))
    return tuple(SensorEntry(name, tuple(channels), why=WHY) for name, channels in of.items())


def name_of(system: str, number: int) -> str:
    """`G07`, as RINEX calls it; SBAS satellites, which others count from 120, from 20."""
    return f"{system}{number - 100 if system == 'S' and number > 100 else number:02}"
