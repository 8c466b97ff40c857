"""The road logs, against the standard library's readings of the same files."""

import csv
from datetime import UTC, datetime
from pathlib import Path

import numpy as np
import pytest

from sensorfault.logs import VehicleFile, guess, read, write

pytestmark = pytest.mark.real


def table(path: Path) -> dict[str, list[str]]:
    with path.open(newline="") as file:
        rows = list(csv.DictReader(file))
    return {name: [row[name] for row in rows] for name in rows[0]}


def test_dresden(real_data: Path) -> None:
    folder = real_data / "road" / "dresden_50hz"
    raw = table(folder / "2014-03-26-000-Data.csv")
    log = read(folder)
    millis = np.array([float(cell) for cell in raw["millis"]])
    np.testing.assert_allclose(log.time, (millis - millis[0]) / 1e3, atol=1e-9)
    assert log.epoch_s == pytest.approx(millis[0] / 1e3, abs=1e-6)
    assert log.period_s == pytest.approx(0.02, rel=0.02)
    scale = {
        "ax": 1,
        "az": 1,
        "yawrate": np.pi / 180,
        "roll": np.pi / 180,
        "speed": 1 / 3.6,
        "course": np.pi / 180,
        "latitude": np.pi / 180,
    }
    channel = {"ax": "accelerometer.x", "az": "accelerometer.z", "yawrate": "gyro.z", "roll": "attitude.roll"}
    for name, factor in scale.items():
        want = np.array([float(cell) for cell in raw[name]]) * factor
        np.testing.assert_allclose(log.value[:, log.index(channel.get(name, name))], want, rtol=1e-12, err_msg=name)
    new = np.array([True] + [a != b for a, b in zip(raw["time"][1:], raw["time"][:-1], strict=True)])
    for name in ("gnss.speed", "gnss.course", "gnss.latitude", "gnss.altitude"):
        np.testing.assert_array_equal(log.fresh[:, log.index(name)], new, err_msg=name)
    assert log.fresh[:, log.of("gyro")].all()
    sensors = {sensor.name: sensor for sensor in log.sensors}
    assert sensors["gnss"].held
    assert sensors["gnss"].period_s == pytest.approx(0.1, rel=0.01)
    assert [c.name for c in log.channels if c.watch and c.sensor in ("attitude", "gnss")] == ["roll", "pitch", "speed"]
    assert list(sensors) == ["accelerometer", "gyro", "attitude", "gnss"]
    assert not sensors["accelerometer"].held
    assert any("14 gaps" in note for note in log.notes)
    assert any("jitters" in note for note in log.notes)


def test_drive_0708(real_data: Path) -> None:
    folder = real_data / "road" / "gnss_imu_drive0708"
    log = read(folder)
    lines = [line.split(",") for line in (folder / "imu_1934.csv").read_text().split()]
    assert len(log) == len(lines)
    assert np.diff(log.time).max() < 0.012
    np.testing.assert_allclose(
        log.value[:, log.index("accelerometer.z")], [float(line[2]) * 9.80665 for line in lines], rtol=1e-12
    )
    np.testing.assert_allclose(
        log.value[:, log.index("gyro.x")], np.radians([float(line[3]) for line in lines]), rtol=1e-12
    )
    rows = [line.split() for line in (folder / "gnss_1934_sf.pos").read_text().splitlines() if not line.startswith("%")]
    gps = [
        datetime.strptime(f"{r[0]} {r[1]} +0000", "%Y/%m/%d %H:%M:%S.%f %z").astimezone(UTC).timestamp() - 18
        for r in rows
    ]
    assert log.epoch_s is not None
    clock = np.array(gps) - log.epoch_s
    inside = (clock > -0.25) & (clock <= log.time[-1])
    tick = np.searchsorted(log.time, clock[inside] - 1e-6)
    fresh = log.fresh[:, log.index("gnss.north")]
    np.testing.assert_array_equal(np.flatnonzero(fresh), tick)
    np.testing.assert_allclose(log.value[tick, log.index("gnss.north")], np.array([float(r[15]) for r in rows])[inside])
    assert np.isnan(log.value[~fresh, log.index("gnss.north")]).all()
    assert {s.name: round(s.period_s, 3) for s in log.sensors} == {
        "gnss": 0.25,
        "accelerometer": 0.01,
        "gyro": 0.01,
    }


def test_the_time_tag_puts_the_gyro_beside_the_track(real_data: Path) -> None:
    """The gyro's turn rate and the RTK track's lie within a tenth of a second of each other."""
    log = read(real_data / "road" / "gnss_imu_drive0708")
    north, east = (log.value[:, log.index(f"gnss.{axis}")] for axis in ("north", "east"))
    at = np.flatnonzero(np.isfinite(north))
    time, speed = log.time[at], np.hypot(north[at], east[at])
    course = np.unwrap(np.arctan2(east[at], north[at]))
    angle = np.concatenate([[0], np.cumsum(np.diff(log.time) * log.value[1:, log.index("gyro.z")])])
    moving = (speed[1:] > 3) & (speed[:-1] > 3)

    def likeness(shift: float) -> float:
        turned = np.diff(np.interp(time - shift, log.time, angle))
        return abs(float(np.corrcoef(turned[moving], np.diff(course)[moving])[0, 1]))

    best = max(np.arange(-0.5, 0.5, 0.01), key=likeness)
    assert likeness(best) > 0.95
    assert abs(best) < 0.1


@pytest.mark.parametrize("name", ["dresden_50hz", "gnss_imu_drive0708"])
def test_guesses_parse_and_logs_survive_writing(real_data: Path, tmp_path: Path, name: str) -> None:
    folder = real_data / "road" / name
    vehicle = guess(folder)
    assert VehicleFile.parse(vehicle.to_toml()) == vehicle
    log = read(folder, vehicle)
    write(log, tmp_path / "copy.csv")
    copy = read(tmp_path / "copy.csv")
    np.testing.assert_allclose(copy.time, log.time, atol=1e-9)
    np.testing.assert_allclose(copy.value, log.value, rtol=1e-12)
    np.testing.assert_array_equal(copy.fresh, log.fresh)
    assert (copy.channels, copy.sensors, copy.name, copy.epoch_s) == (log.channels, log.sensors, log.name, log.epoch_s)
