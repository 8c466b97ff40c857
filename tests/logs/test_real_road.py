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


def test_comma2k19(real_data: Path) -> None:
    folder = real_data / "road" / "comma2k19_rav4"

    def array(name: str) -> np.ndarray:
        stored: np.ndarray = np.load(folder / f"{name}.npy", allow_pickle=False)
        return stored

    log = read(folder)
    ticks = array("IMU__gyro__t")
    assert log.duration_s == pytest.approx(59.992, abs=1e-3)
    np.testing.assert_allclose(log.time, ticks - ticks[0], atol=1e-9)
    rates = {sensor.name: 1 / sensor.period_s for sensor in log.sensors}
    usual = {"accelerometer": 104.4, "gyro": 104.4, "speed": 89.2, "steering": 89.1, "wheels": 89.2, "velocity": 20.0}
    usual |= {"live_gnss_ublox": 9.99, "live_gnss_qcom": 0.50, "magnetometer": 10.0}
    assert {name: rates[name] for name in usual} == pytest.approx(usual, rel=0.005)
    for path, name, column, factor in (
        ("gyro.z", "IMU__gyro", 2, 1.0),
        ("accelerometer.x", "IMU__accelerometer", 0, 1.0),
        ("steering.angle", "CAN__steering_angle", None, np.pi / 180),
        ("wheels.rear_left", "CAN__wheel_speed", 2, 1.0),
        ("live_gnss_ublox.latitude", "GNSS__live_gnss_ublox", 0, np.pi / 180),
        ("live_gnss_ublox.altitude", "GNSS__live_gnss_ublox", 4, 1.0),
        ("live_gnss_ublox.course", "GNSS__live_gnss_ublox", 5, np.pi / 180),
        ("magnetometer.y", "IMU__magnetometer", 1, 1e-6),
    ):
        time, value = array(f"{name}__t"), array(f"{name}__value")
        value = value if column is None else value[:, column]
        # the last measurement that had come by each tick
        latest = np.searchsorted(time, ticks + 1e-6, side="right") - 1
        fresh = np.flatnonzero(log.fresh[:, log.index(path)])
        got = log.value[fresh, log.index(path)]
        np.testing.assert_allclose(got, value[latest[fresh]] * factor, rtol=1e-12, err_msg=path)
        assert (latest[fresh[-1]], got[-1]) == (latest[-1], pytest.approx(value[latest[-1]] * factor))
    pose = np.searchsorted(ticks, array("global_pose__frame_times") - 1e-6)
    np.testing.assert_array_equal(np.flatnonzero(log.fresh[:, log.index("velocity.x")]), pose)
    np.testing.assert_array_equal(
        log.value[pose, log.index("velocity.x")], array("global_pose__frame_velocities")[:, 0]
    )
    ends = log.value[[pose[0], pose[-1]]][:, log.of("quaternion")]
    np.testing.assert_allclose(ends[:, 0], [0.212439, 0.221213], atol=1e-6)


def test_comma2k19_axes_and_signs(real_data: Path) -> None:
    """x forward, y right, z down; the steering angle is positive to the left, the gyro's yaw rate to the right."""
    log = read(real_data / "road" / "comma2k19_rav4")
    assert np.nanmean(log.value[:, log.index("accelerometer.z")]) == pytest.approx(-9.66, abs=0.01)
    second = np.arange(1, 59)
    speed, yaw, angle, ahead = (
        np.array([np.nanmean(log.value[(log.time >= s) & (log.time < s + 1), log.index(path)]) for s in second])
        for path in ("speed.speed", "gyro.z", "steering.angle", "accelerometer.x")
    )
    assert np.corrcoef(np.gradient(speed), ahead)[0, 1] > 0.8
    assert np.corrcoef(speed * angle, yaw)[0, 1] < -0.9
    # yaw rate = speed × steering angle / (ratio × wheelbase): 27 at these speeds, with the understeer of the car in it
    slope = np.polyfit(speed * angle / 2.66, -yaw, 1)[0]
    assert 1 / slope == pytest.approx(28, abs=2)
