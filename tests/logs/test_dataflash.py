"""DataFlash logs, written here byte by byte: what is read, and each bad one as one sentence."""

import struct
from pathlib import Path

import numpy as np
import pytest

from sensorfault.logs import LogError, VehicleFile, guess, read

FMT = 128
KINDS = {  # number, format, columns
    "GPS": (130, "BIHBfffffffI", "Status,TimeMS,Week,NSats,HDop,Lat,Lng,RelAlt,Alt,Spd,VZ,T"),
    "ATT": (131, "Ifff", "TimeMS,Roll,Pitch,Yaw"),
    "IMU": (132, "QBffffff", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ"),
    "MSG": (133, "Z", "Message"),
}
PLAIN = {"Z": "64s"}
RANDOM = np.random.default_rng(5)


def message(kind: str, *values: object) -> bytes:
    number, form, _ = KINDS[kind]
    return b"\xa3\x95" + bytes([number]) + struct.pack("<" + "".join(PLAIN.get(c, c) for c in form), *values)


def formats() -> bytes:
    said = b""
    own = ("FMT", FMT, "BBnNZ", "Type,Length,Name,Format,Columns")
    for name, number, form, columns in (own, *((name, *kind) for name, kind in KINDS.items())):
        plain = "BB4s16s64s" if name == "FMT" else "".join(PLAIN.get(c, c) for c in form)
        row = (number, struct.calcsize("<" + plain) + 3, name.encode(), form.encode(), columns.encode())
        said += b"\xa3\x95" + bytes([FMT]) + struct.pack("<BB4s16s64s", *row)
    return said


def flight(imus: int = 1) -> bytes:
    """10 s: attitude and IMU at 50 Hz, fixes at 5 Hz on GPS time with the autopilot's own beside it."""
    said = formats() + message("MSG", b"hello")
    for k in range(500):
        ms = 3000 + 20 * k
        for i in range(imus):
            gyro = RANDOM.normal(0, 0.1, 3)
            said += message("IMU", 1000 * ms, i, *gyro, i + 0.1 * np.sin(k), 0.0, -9.8 + RANDOM.normal(0, 0.1))
        said += message("ATT", ms, 10 * np.sin(k / 50), 5 * np.cos(k / 40), 180 + 170 * np.sin(k / 100))
        if k % 10 == 0:
            fix = (1.5, 30.1 + 1e-4 * k, -97.9, k / 10, 300 + k / 10, 3.0 + 0.1 * (k % 7), 0.1 * np.sin(k), ms)
            said += message("GPS", 3, 388000000 + 20 * k, 1815, 9, *fix)
    return said


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
