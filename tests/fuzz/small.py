"""A small sound file of each format. A new format is one more line in SMALL, by its title in FORMATS."""

import gzip
from collections.abc import Callable
from pathlib import Path

import numpy as np
import polars as pl
from pynmeagps import NMEAMessage
from pyubx2 import GET, UBXMessage
from scipy.io import savemat

from fuzz import texts
from logs import (
    written_ardupilot,
    written_bus,
    written_dataflash,
    written_foxglove,
    written_mat73,
    written_ros,
    written_subframes,
    written_ulog,
)

TIME = np.arange(60) / 10
COLUMNS = {"t": TIME, "ax": np.sin(TIME), "ay": np.cos(TIME), "az": 9.8 + 0.1 * np.sin(3 * TIME)}


def _csv(folder: Path) -> Path:
    path = folder / "drive.csv"
    pl.DataFrame(COLUMNS).write_csv(path)
    return path


def _gzipped(folder: Path) -> Path:
    plain = _csv(folder)
    path = folder / "drive.csv.gz"
    path.write_bytes(gzip.compress(plain.read_bytes(), mtime=0))
    plain.unlink()
    return path


def _parquet(folder: Path) -> Path:
    path = folder / "drive.parquet"
    pl.DataFrame(COLUMNS).write_parquet(path)
    return path


def _npy(folder: Path) -> Path:
    np.save(folder / "accelerometer__t.npy", TIME)
    path = folder / "accelerometer__value.npy"
    np.save(path, np.column_stack([COLUMNS[name] for name in ("ax", "ay", "az")]))
    return path


def _mat(folder: Path) -> Path:
    path = folder / "flight.mat"
    savemat(path, {"flight_data": {name: value[:, None] for name, value in COLUMNS.items()}})
    return path


def _text(name: str, content: Callable[[], str]) -> Callable[[Path], Path]:
    def write(folder: Path) -> Path:
        path = folder / name
        path.write_text(content())
        return path

    return write


def ubx(folder: Path) -> Path:
    """Twelve epochs of three satellites and as many fixes, in pyubx2's own words."""
    path = folder / "rover.ubx"
    path.write_bytes(b"".join(_raw(k).serialize() + _fix(k).serialize() for k in range(12)))
    return path


def _raw(k: int) -> UBXMessage:
    result: dict[str, float] = {"rcvTow": 1000.0 + k, "week": 2381, "leapS": 18, "numMeas": 3}
    for i, satellite in enumerate((7, 12, 30), 1):
        result |= {
            f"prMes_{i:02}": 2.1e7 + 100.5 * k + i,
            f"doMes_{i:02}": -500.25,
            f"gnssId_{i:02}": 0,
            f"svId_{i:02}": satellite,
            f"cno_{i:02}": 40 + i,
            f"prStd_{i:02}": 5,
            f"prValid_{i:02}": 1,
        }
    return UBXMessage("RXM", "RXM-RAWX", GET, **result)


def _fix(k: int) -> UBXMessage:
    when = {"year": 2025, "month": 8, "day": 24, "hour": 0, "min": 16, "second": 22 + k, "nano": 250_000_000}
    valid = {"validDate": 1, "validTime": 1, "gnssFixOk": 1, "fixType": 3}
    return UBXMessage(
        "NAV", "NAV-PVT", GET, **when, **valid, lat=48.1 + 1e-5 * k, lon=-11.6, height=512_345, velN=1500, velE=-20 * k
    )


def nmea(folder: Path) -> Path:
    """A dozen seconds of GGA and RMC, in pynmeagps' own words."""
    path = folder / "rover.nmea"
    place = {"NS": "N", "EW": "E"}
    said = []
    for k in range(12):
        now = {"time": f"12:00:{k:02}", "lat": 48.1 + 1e-5 * k, "lon": 11.6, **place}
        said += [
            NMEAMessage("GN", "GGA", GET, **now, quality=4, numSV=12, HDOP=0.6, alt=512.3, altUnit="M"),
            NMEAMessage("GN", "RMC", GET, **now, status="A", spd=3.6, cog=90.0, date="2025-08-24"),
        ]
    path.write_bytes(b"".join(one.serialize() for one in said))
    return path


def _bytes(name: str, content: Callable[[], bytes]) -> Callable[[Path], Path]:
    def write(folder: Path) -> Path:
        path = folder / name
        path.write_bytes(content())
        return path

    return write


SMALL: dict[str, Callable[[Path], Path]] = {
    "text table": _csv,
    "gzip": _gzipped,
    "Parquet": _parquet,
    "NumPy arrays": _npy,
    "MATLAB": _mat,
    "MATLAB, version 7.3": lambda folder: written_mat73.save(folder / "flight.mat", {"flight_data": COLUMNS}),
    "MATLAB, version 7.3, not packed": lambda folder: written_mat73.save(
        folder / "flight.mat", {"flight_data": COLUMNS}, packed=False
    ),
    "RTKLIB solution": _text("rover.pos", texts.pos),
    "libRSF measurements": _text("car_Input.txt", texts.librsf),
    "smartLoc measurements": _text("RXM-RAWX.csv", texts.smartloc),
    "UTIAS measurements": _text("Robot1_Measurement.dat", texts.utias),
    "PX4 ULog": _bytes("flight.ulg", lambda: written_ulog.flight(1.0)),
    "ArduPilot DataFlash": _bytes("flight.bin", lambda: written_dataflash.flight(seconds=2.0)),
    "ArduPilot DataFlash text": _text("flight.log", lambda: written_ardupilot.text(1.0)),
    "MAVLink telemetry": _bytes("flight.tlog", lambda: written_ardupilot.tlog(1.0)),
    "ROS 1 bag": lambda folder: written_ros.bag1(folder / "drive.bag", seconds=0.5),
    "ROS 1 bag, in lz4": lambda folder: written_ros.bag1(folder / "drive.bag", compress=True, seconds=0.5),
    "ROS 2 bag": lambda folder: written_ros.bag2(folder / "drive", seconds=0.5),
    "MCAP": lambda folder: written_ros.bag2(folder / "drive", mcap=True, seconds=0.5),
    "MCAP, of JSON": lambda folder: written_ros.mcap(folder / "drive.mcap"),
    "MCAP, of protocol buffers": lambda folder: written_foxglove.mcap(folder / "drive.mcap", count=20),
    "MDF": lambda folder: written_bus.mdf(folder / "drive.mf4"),
    "CAN recording": lambda folder: written_bus.blf(folder / "drive.blf"),
    "CAN recording, as text": lambda folder: written_bus.asc(folder / "drive.asc"),
    "u-blox": ubx,
    "u-blox, with ephemerides": lambda folder: written_subframes.rover(folder / "rover.ubx"),
    "NMEA": nmea,
    "RINEX observations": _text("site.obs", texts.rinex_3),
    "RINEX observations, version 2": _text("site.25o", texts.rinex_2),
    "RINEX navigation": _text("site.nav", texts.navigation),
    "SP3 orbits": _text("day.sp3", texts.sp3),
}
