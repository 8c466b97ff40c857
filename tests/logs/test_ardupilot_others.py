"""ArduPilot's text log and MAVLink telemetry: what is read, what is a sensor, where a broken one breaks."""

from pathlib import Path

import numpy as np
import pytest

from logs.written_ardupilot import START_US, text, tlog
from sensorfault.logs import LogError, VehicleFile, guess, read
from sensorfault.logs.readers.formats import read_tables


def put(folder: Path, content: str | bytes, suffix: str) -> Path:
    path = folder / f"flight{suffix}"
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


def test_a_text_log(tmp_path: Path) -> None:
    path = put(tmp_path, text(), ".log")
    vehicle = guess(path)
    assert VehicleFile.parse(vehicle.to_toml()) == vehicle
    assert {file.table for file in vehicle.files} == {"IMU", "IMU[1]", "GPS", "BARO", "ATT"}
    log = read(path, vehicle)
    assert log.duration_s == pytest.approx(9.98)
    assert log.value[0, log.index("gnss.latitude")] == pytest.approx(np.deg2rad(48))
    assert log.value[0, log.index("barometer.pressure")] == 95_000
    np.testing.assert_array_equal(np.flatnonzero(log.fresh[:, log.index("gnss.down")]), np.arange(0, 500, 10))
    assert log.damage == ()


def test_a_text_log_with_odd_lines(tmp_path: Path) -> None:
    lines = text().splitlines(keepends=True)
    lines[100] = "\x00\xff rubbish\n"
    lines[200] = "IMU, 17\n"
    log = read(put(tmp_path, "".join(lines)[:-9], ".log"))
    assert log.damage == (
        "flight.log: 2 lines are not messages, the first at line 101; the others were read.",
        f"flight.log: the file breaks off at line {len(lines)}; what came before was read.",
    )


@pytest.mark.parametrize("v1", [False, True])
def test_telemetry(tmp_path: Path, v1: bool) -> None:
    path = put(tmp_path, tlog(v1=v1), ".tlog")
    vehicle = guess(path)
    assert VehicleFile.parse(vehicle.to_toml()) == vehicle
    assert "a log of MAVLink; sensors are in" in vehicle.notes[0]
    log = read(path, vehicle)
    assert log.duration_s == pytest.approx(9.9)
    assert log.epoch_s == pytest.approx(START_US / 1e6)
    np.testing.assert_allclose(log.value[:, log.index("attitude.roll")], 0.2 * np.sin(np.arange(100) / 10), atol=1e-6)
    assert log.value[:, log.index("accelerometer.z")].mean() == pytest.approx(-9.80665, abs=0.05)
    assert log.value[0, log.index("gnss.altitude")] == pytest.approx(100)
    assert log.value[0, log.index("barometer.pressure")] == pytest.approx(95_000)
    assert "HEARTBEAT[255.190]" in read_tables(path)
    assert log.damage == ()


def test_telemetry_that_breaks_off_and_has_rubbish(tmp_path: Path) -> None:
    whole = tlog()
    assert "breaks off inside the packet at byte" in read(put(tmp_path, whole[:-5], ".tlog")).damage[0]
    log = read(put(tmp_path, whole[:3000] + b"\xfe\xfd\x00" * 50 + whole[3000:], ".tlog"))
    assert log.duration_s == pytest.approx(9.9)
    (result,) = log.damage
    assert "bytes are not in a whole packet, the first at byte" in result
    assert 2900 < int(result.split("at byte ")[1].split(";")[0]) <= 3000


def test_telemetry_whose_clock_jumps_by_a_day(tmp_path: Path) -> None:
    whole, later = tlog(), tlog(1.0)
    day = (86_400 * 10**6).to_bytes(8, "big")
    assert len(day) == 8
    moved = bytearray(later)
    at = 0
    while at < len(moved):
        shifted = int.from_bytes(moved[at : at + 8], "big") + 86_400 * 10**6
        moved[at : at + 8] = shifted.to_bytes(8, "big")
        at += 8 + 12 + moved[at + 9]
    log = read(put(tmp_path, whole + bytes(moved), ".tlog"))
    assert log.duration_s > 86_000
    assert len(log) < 1000
    assert any("The recording has 1 gap, 863" in note for note in log.notes)
    assert len(log.pauses) == 1


@pytest.mark.parametrize("suffix", [".log", ".tlog"])
@pytest.mark.parametrize("content", [b"", b"\x00" * 300, b"FMT, 128\n", b"\xfe" * 400, tlog(0.1)[:-1][:20]])
def test_what_is_no_flight(tmp_path: Path, suffix: str, content: bytes) -> None:
    with pytest.raises(LogError) as error:
        read(put(tmp_path, content, suffix))
    assert "\n" not in str(error.value)
