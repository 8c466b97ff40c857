"""Every table among the real logs, against the standard library's reading of the same cells.

Of each: duration, and of each channel the first and the last value.
"""

import csv
import gzip
import math
import re
from datetime import datetime
from pathlib import Path

import numpy as np
import pytest

from sensorfault.logs import guess, read

pytestmark = pytest.mark.real

FOLDERS = ("arm", "gnss", "ranging", "road", "uav", "underwater")  # those whose tables this test knows by heart
NO_TIME = ("Barcodes", "Landmark_Groundtruth", "land_detected", "vehicle_status", "wind_estimate")  # nor measurements
SECONDS = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "ns": 1e-9}
SI = {
    "": 1.0,
    "rad": 1.0,
    "1": 1.0,
    "%": 0.01,
    "T": 1.0,
    "gauss": 1e-4,
    "dB": 1.0,
    "dBm": 1.0,
    "rad/s": 1.0,
    "m": 1.0,
    "m/s": 1.0,
    "m/s^2": 1.0,
    "deg": math.pi / 180,
    "deg/s": math.pi / 180,
    "1e-7deg": 1e-7 * math.pi / 180,
    "km/h": 1 / 3.6,
    "mm": 1e-3,
    "g": 9.80665,
    "Pa": 1.0,
    "kPa": 1e3,
    "mbar": 100.0,
    "degC": 1.0,
}


def cells(path: Path) -> dict[str, list[str]]:
    """A table's columns; those of one without a header are c1, c2, ..."""
    packed = path.suffix == ".gz"
    text = gzip.decompress(path.read_bytes()).decode() if packed else path.read_text()
    rows = list(csv.reader(text.splitlines()))
    if packed:
        lines = [line for line in text.splitlines() if line.strip()]
        head = [line.lstrip("# ") for line in lines if line.startswith("#")][-1]
        rows = [re.split(r"\s{2,}", head), *(line.split() for line in lines if not line.startswith("#"))]
    width = len(rows[len(rows) // 2])
    rows = [row for row in rows if len(row) == width]
    try:
        float(rows[0][-1])
        names = [f"c{i + 1}" for i in range(width)]
    except ValueError:
        names, rows = [name.strip().lstrip("%") for name in rows[0]], rows[1:]
    return dict(zip(names, zip(*rows, strict=True), strict=True))  # type: ignore[arg-type]


def number(cell: str) -> float:
    try:
        return float(cell)
    except ValueError:
        return datetime.fromisoformat(cell).timestamp() if cell[:2] == "20" else math.nan


def first(column: list[str], rows: np.ndarray, missing: float | None) -> float:
    """The first of these cells that says a number."""
    said = (number(column[i]) for i in rows)
    return next(one for one in said if math.isfinite(one) and one != missing)


def test_every_table(real_data: Path) -> None:
    every = (path for name in FOLDERS for end in ("*.csv", "*ry.dat.gz") for path in (real_data / name).rglob(end))
    tables = [path for path in every if "RXM" not in path.name]
    tables = [path for path in tables if not any(name in path.name for name in NO_TIME)]
    assert len(tables) > 60
    for path in tables:
        raw, vehicle, log = cells(path), guess(path), read(path)
        (file,) = vehicle.files
        assert file.time is not None
        time = np.array([number(cell) for cell in raw[file.time]])
        scale = SECONDS.get(file.unit, 1.0)
        rising = np.flatnonzero(np.diff(np.maximum.accumulate(time), prepend=-np.inf) > 0)  # the others are left out
        drift = 2e-5 if file.tag else 0.0  # the tag says how fast the counter runs
        assert log.duration_s == pytest.approx((time[rising[-1]] - time[0]) * scale, abs=2e-6, rel=drift), path
        steps = np.diff(time[rising]) * scale
        assert log.period_s == pytest.approx(np.median(steps), abs=1e-6 + 0.01 * np.median(steps)), path
        for sensor in vehicle.sensors:
            for channel in sensor.channels:
                if "of_quaternion" in channel.column:
                    continue  # drawn from others
                result = log.value[:, log.index(f"{sensor.name}.{channel.name}")]
                result = result[np.isfinite(result)][[0, -1]]
                want = [first(raw[channel.column], rows, channel.missing) for rows in (rising, rising[::-1])]
                want = np.multiply(want, SI[channel.unit])
                np.testing.assert_allclose(result, want, rtol=1e-12, err_msg=f"{path} {channel.column}")
