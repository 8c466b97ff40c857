"""DataFlash logs: what is read, and each bad one as one sentence."""

import struct
from pathlib import Path

import numpy as np
import pytest

from logs.written_dataflash import flight, formats, message
from sensorfault.logs import LogError, VehicleFile, guess, read
from sensorfault.logs.readers.formats import read_tables


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


def test_numbers_and_units_as_the_log_describes_them(tmp_path: Path) -> None:
    """A type with factors of its own, units by UNIT, MULT and FMTU."""

    def described(number: int, name: str, form: str, columns: str, size: int) -> bytes:
        row = struct.pack("<BB4s16s64s", number, size + 3, name.encode(), form.encode(), columns.encode())
        return b"\xa3\x95\x80" + row

    def said(number: int, form: str, *values: object) -> bytes:
        return b"\xa3\x95" + bytes([number]) + struct.pack("<" + form, *values)

    content = formats() + described(140, "UNIT", "QbZ", "TimeUS,Id,Label", 73)
    content += described(141, "MULT", "Qbd", "TimeUS,Id,Mult", 17) + described(
        142, "FMTU", "QBNN", "TimeUS,FmtType,UnitIds,MultIds", 41
    )
    content += described(143, "ODD", "QLch", "TimeUS,Lat,Tilt,Acc", 16)
    for letter, unit in (("s", b"s"), ("D", b"deglatitude"), ("d", b"deg"), ("o", b"m/s/s")):
        content += said(140, "Qb64s", 0, ord(letter), unit)
    content += said(141, "Qbd", 0, ord("C"), 1e-3) + said(142, "QB16s16s", 0, 143, b"sDdo", b"F--C")
    content += b"".join(said(143, "Qihh", 1000 * k, 481234567 + k, 150 + k, k) for k in range(20))
    table = read_tables(put(tmp_path, content))["ODD"]
    assert table.frame["Lat"][0] == 48.1234567
    assert table.frame["Tilt"][3] == 1.53
    assert (table.units["Lat"], table.units["Tilt"]) == ("deg", "deg")


@pytest.mark.parametrize(("form", "columns"), [(b"Qf", b"TimeUS,a\nb"), (b"Qf", b"TimeUS,a,b"), (b"Qd", b"TimeUS,a")])
def test_a_kind_described_with_contradictions_is_left_out_and_said(tmp_path: Path, form: bytes, columns: bytes) -> None:
    odd = b"\xa3\x95\x80" + struct.pack("<BB4s16s64s", 140, 15, b"ODD", form, columns)
    odd += b"".join(b"\xa3\x95\x8c" + struct.pack("<Qf", 3_000_000 + k, k) for k in range(20))
    tables = read_tables(put(tmp_path, flight() + odd))
    assert "ODD" not in tables
    assert tables["IMU"].notes == ("flight.bin: messages with contradictory descriptions left out: 'ODD'.",)
    assert tables["IMU"].damage == ()


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
