"""PX4's logs, written here byte by byte: what is read, what is a sensor, and where a broken one breaks."""

import struct
from pathlib import Path

import numpy as np
import pytest
from pyulog import ULog

from logs.written_ulog import FORMATS, HEAD, flight, head, message
from sensorfault.logs import LogError, VehicleFile, guess, read
from sensorfault.logs.readers.source import Ask
from sensorfault.logs.readers.ulog import read_ulog


def put(folder: Path, content: bytes) -> Path:
    path = folder / "flight.ulg"
    path.write_bytes(content)
    return path


def test_every_topic_on_the_autopilots_clock(tmp_path: Path) -> None:
    path = put(tmp_path, flight())
    tables = read_ulog(path, Ask())
    assert set(tables) == {*FORMATS, "vehicle_gps_position[1]"}
    combined = tables["sensor_combined"]
    assert (combined.time, combined.unit) == ("timestamp", "us")
    assert [name for name in combined.frame.columns if "padding" in name] == []
    np.testing.assert_array_equal(combined.frame["timestamp"], 5_000_000 + 20_000 * np.arange(500))
    assert tables["vehicle_gps_position[1]"].frame["lat"][0] == 470_000_000
    assert combined.damage == ()


def test_only_the_topics_asked_for(tmp_path: Path) -> None:
    path = put(tmp_path, flight(1))
    assert set(read_ulog(path, Ask(frozenset({"vehicle_gps_position[1]"})))) == {"vehicle_gps_position[1]"}


def test_a_stock_log_needs_no_hand(tmp_path: Path) -> None:
    path = put(tmp_path, flight())
    vehicle = guess(path)
    assert VehicleFile.parse(vehicle.to_toml()) == vehicle
    assert "Left out as not sensors: cpuload." in vehicle.notes[0]
    log = read(path, vehicle)
    assert log.duration_s == pytest.approx(9.98)
    roll = log.index("attitude.roll")
    np.testing.assert_allclose(log.value[:, roll], 0.2 * np.sin(np.arange(500) / 50), atol=1e-6)
    assert log.value[0, log.index("gnss.altitude")] == 500
    assert log.value[0, log.index("gnss.latitude")] == pytest.approx(np.deg2rad(47))
    assert log.value[log.fresh[:, log.index("barometer.altitude")]].shape[0] == 100
    assert log.value[:, log.index("accelerometer.z")].mean() == pytest.approx(-9.8, abs=0.05)


@pytest.mark.parametrize("cut", [1, 2, 3, 5, 17])
def test_a_log_that_breaks_off_is_read_so_far_and_says_where(tmp_path: Path, cut: int) -> None:
    content = flight()
    log = read(put(tmp_path, content[:-cut]))
    assert log.duration_s > 9.9
    (result,) = log.damage
    assert f"flight.ulg: the file breaks off inside a message at byte {len(content) - cut};" in result


def test_rubbish_inside_is_passed_over_and_said(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    content = flight()
    log = read(put(tmp_path, content[:8000] + b"\x00" * 400 + content[8000:]))
    assert log.duration_s == pytest.approx(9.98)
    assert "messages that cannot be read, the first at byte 8" in log.damage[0]
    assert capfd.readouterr() == ("", "")


def test_what_the_autopilot_could_not_write_is_said(tmp_path: Path) -> None:
    log = read(put(tmp_path, flight() + message("O", struct.pack("<H", 250)) * 2))
    assert "flight.ulg: the autopilot lost data 2 times, 0.5 s in all." in log.notes


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "an empty file"),
        (b"ULog", "not a ULog"),
        (b"\xa3\x95" * 200, "not a ULog"),
        (HEAD[:12], "damaged"),
        (HEAD, "no topic with a time"),
        (head(), "no topic with a time"),
        (HEAD + b"\xff" * 500, "damaged"),
    ],
)
def test_what_is_no_log(tmp_path: Path, content: bytes, said: str) -> None:
    with pytest.raises(LogError, match=said) as error:
        read(put(tmp_path, content))
    assert "\n" not in str(error.value)


@pytest.mark.real
def test_the_sample_of_pyulog(real_data: Path) -> None:
    log = read(real_data / "uav" / "pyulog_sample" / "sample.ulg")
    assert log.duration_s == pytest.approx(68.9, abs=0.1)
    assert log.period_s == pytest.approx(0.004, abs=2e-4)
    measured = [sensor.name for sensor in log.measurements().sensors]
    assert measured == ["gyro", "accelerometer", "magnetometer", "attitude"]
    assert {sensor.name for sensor in log.sensors} - set(measured) == {
        "estimated_local_position",
        "throttle",
        "estimator",
        "motors",
        "armed",
        "mode",
    }
    assert len(log.pauses) == 5
    assert np.nanmean(log.value[:, log.index("accelerometer.z")]) == pytest.approx(-9.62, abs=0.05)
    attitude = log.value[log.fresh[:, log.index("attitude.roll")]]
    assert len(attitude) == 6460
    topic = ULog(str(real_data / "uav" / "pyulog_sample" / "sample.ulg")).get_dataset("sensor_combined").data
    gyro = log.value[log.fresh[:, log.index("gyro.x")], log.index("gyro.x")]
    np.testing.assert_array_equal(gyro[[0, -1]], topic["gyro_rad[0]"][[0, -1]].astype(float))
    assert log.damage == ()
