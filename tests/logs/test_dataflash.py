"""DataFlash logs: what is read, and each bad one as one sentence."""

from pathlib import Path

import numpy as np
import pytest

from logs.written_dataflash import flight, formats, message
from sensorfault.logs import LogError, VehicleFile, guess, read


def put(folder: Path, content: bytes) -> Path:
    path = folder / "flight.bin"
    path.write_bytes(content)
    return path


def test_every_kind_of_message_on_the_autopilots_clock(tmp_path: Path) -> None:
    path = put(tmp_path, flight())
    vehicle = guess(path)
    assert VehicleFile.parse(vehicle.to_toml()) == vehicle
    assert {file.table: file.time for file in vehicle.files} == {"IMU": "TimeUS", "ATT": "TimeMS", "GPS": "T"}
    log = read(path, vehicle)
    assert log.duration_s == pytest.approx(9.98)
    fix = np.flatnonzero(log.fresh[:, log.index("gnss.altitude")])
    np.testing.assert_array_equal(fix, np.arange(0, 500, 10))
    np.testing.assert_allclose(log.value[fix, log.index("gnss.altitude")], 300 + np.arange(50.0), rtol=1e-6)
    np.testing.assert_allclose(log.value[0, log.index("attitude.yaw")], np.pi, rtol=1e-6)


def test_several_imus_are_several_tables(tmp_path: Path) -> None:
    vehicle = guess(put(tmp_path, flight(imus=2)))
    assert {file.table for file in vehicle.files} >= {"IMU", "IMU[1]"}
    log = read(tmp_path / "flight.bin", vehicle)
    second = next(sensor.name for sensor in vehicle.sensors if sensor.file == "imu_1" and "acc" in sensor.name)
    assert log.value[:, log.index(f"{second}.x")].mean() == pytest.approx(1.0, abs=0.01)


def test_a_log_that_breaks_off_is_read_so_far(tmp_path: Path) -> None:
    whole = flight()
    log = read(put(tmp_path, whole[: len(whole) // 2 + 5]))
    assert 4.5 < log.duration_s < 5.5


def test_rubbish_inside_a_log_is_passed_over(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    whole = flight()
    log = read(put(tmp_path, whole[:8000] + bytes(range(1, 250)) * 40 + whole[8000:]))
    assert log.duration_s == pytest.approx(9.98)
    assert any("9960 bytes belong to no message, the first at byte" in note for note in log.damage)
    assert capfd.readouterr() == ("", "")  # pymavlink's own remarks go nowhere


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (b"", "an empty file"),
        (b"\x00" * 500, "does not begin with A3 95"),
        (b"timestamp,alt\n1,2\n", "does not begin with A3 95"),
        (b"\xa3\x95", "no messages with a time|damaged"),
        (b"\xa3\x95" + b"\x07" * 300, "no messages with a time|damaged"),
        (formats(), "no messages with a time"),
        (formats() + message("MSG", b"hello") * 3, "no messages with a time"),
    ],
)
def test_what_is_no_log(tmp_path: Path, content: bytes, said: str) -> None:
    with pytest.raises(LogError, match=said) as error:
        read(put(tmp_path, content))
    assert "\n" not in str(error.value)
