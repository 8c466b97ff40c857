"""Clocks that go back or jump in a log that is read part by part: as in the log read whole."""

from pathlib import Path

import numpy as np
import pytest

from sensorfault.logs import Log, LogError, read
from sensorfault.logs.parts import read_parts
from sensorfault.logs.readers import dataflash_text

HEAD = "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\nFMT, 132, 40, BARO, Qff, TimeUS,Alt,Press\n"
HEAD += "FMT, 131, 40, IMU, Qfff, TimeUS,AccX,AccY,AccZ\n"
VEHICLE = """[file.imu]
table = "IMU"
[file.baro]
table = "BARO"
[sensor.accelerometer]
file = "imu"
[sensor.accelerometer.channel]
x = { column = "AccX", unit = "m/s^2" }
[sensor.barometer]
file = "baro"
[sensor.barometer.channel]
altitude = { column = "Alt", unit = "m" }
"""


@pytest.fixture(autouse=True)
def small_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(dataflash_text, "PART_CELLS", 400)


def imu(us: int, k: int) -> str:
    return f"IMU, {us}, {np.sin(k)}, {np.cos(k)}, -9.8\n"


def flown(folder: Path, lines: list[str]) -> Path:
    path = folder / "flight.log"
    path.write_text(HEAD + "".join(lines))
    (folder / "vehicle.toml").write_text(VEHICLE)
    return path


def flight(rows: int, baro: int = 10) -> list[str]:
    """An IMU at 100 Hz, a barometer once in so many rows, written down three rows late."""
    lines = [imu(10_000 * k, k) for k in range(rows)]
    for k in range(3, rows, baro):
        lines[k] += f"BARO, {10_000 * (k - 3)}, {k}, 9e4\n"
    return lines


def by_parts(path: Path) -> tuple[Log, list[str], int]:
    parts: list[Log] = []
    said = read_parts(path, parts.append)
    time, value = np.concatenate([p.time for p in parts]), np.concatenate([p.value for p in parts])
    fresh = np.concatenate([p.fresh for p in parts])
    return Log(time, value, fresh, parts[0].channels, parts[0].sensors), list(said.notes), len(parts)


def assert_same(path: Path) -> list[str]:
    whole, (log, notes, parts) = read(path), by_parts(path)
    assert parts > 5
    np.testing.assert_allclose(log.time, whole.time, atol=1e-9)
    np.testing.assert_array_equal(log.value, whole.value)
    np.testing.assert_array_equal(log.fresh, whole.fresh)
    return notes


def test_a_short_second_boot_is_left_out_and_said(tmp_path: Path) -> None:
    notes = assert_same(flown(tmp_path, [*flight(2000), *flight(300)]))
    assert "flight.log (IMU): time 'TimeUS' goes back (first row 2001); 300 rows left out." in notes
    assert not any("come much later" in note for note in notes)


def test_two_boots_are_no_log(tmp_path: Path) -> None:
    path = flown(tmp_path, [*flight(2000), *flight(1500)])
    with pytest.raises(LogError, match="rows are out of order"):
        read(path)
    with pytest.raises(LogError, match=r"goes back \(first row 2001\), so 1500 of 3500 rows are out of order"):
        by_parts(path)


@pytest.mark.parametrize("us", [0, 10**15])
def test_a_wild_reading_costs_one_row_wherever_it_stands(tmp_path: Path, us: int) -> None:
    lines = flight(4000)
    for k in range(50, 4000, 9):
        lines[k] = lines[k].replace(f"IMU, {10_000 * k},", f"IMU, {us},")
    path = flown(tmp_path, lines)
    whole, (log, _, _) = read(path), by_parts(path)
    assert log.fresh[:, 0].sum() == whole.fresh[:, 0].sum() == 4000 - 439
    np.testing.assert_array_equal(log.value[log.fresh[:, 1], 1], whole.value[whole.fresh[:, 1], 1])


def test_a_sensor_slower_than_the_parts_loses_nothing_but_its_first_row(tmp_path: Path) -> None:
    """One row alone has no clock, and has long been handed on as absent when the second comes."""
    path = flown(tmp_path, flight(2000, baro=330))
    whole, (log, _, _) = read(path), by_parts(path)
    np.testing.assert_array_equal(log.value[1:], whole.value[1:])
    assert np.isfinite(whole.value[1:, 1]).sum() == 6


def test_ticks_stay_with_their_sensor(tmp_path: Path) -> None:
    """Two sensors of one rate, never at the same time; now and then the other runs faster by a thousandth."""
    lines = [
        imu(10_000 * k, k) + f"BARO, {10_000 * k + 5000 + 10 * abs((k + 200) % 400 - 200)}, {k}, 9e4\n"
        for k in range(2000)
    ]
    log, _, _ = by_parts(flown(tmp_path, lines))
    np.testing.assert_allclose(log.time, 0.01 * np.arange(2000), atol=1e-6)


def test_places_are_told_from_the_beginning_of_the_file_and_once(tmp_path: Path) -> None:
    lines = flight(2000)
    del lines[1503:1507]
    lines[1800] = f"IMU, 18000000, {1.5}, x, 0\n"
    notes = assert_same(flown(tmp_path, lines))
    assert [note for note in notes if "gap" in note] == [
        "The recording has 1 gap, 0.05 s in all, the longest 0.05 s at 15.020 s; nothing is judged there, and no "
        "sensor is called missing."
    ]


def test_the_edge_of_a_part_is_no_loss(tmp_path: Path) -> None:
    assert assert_same(flown(tmp_path, flight(2000))) == []


def test_a_jump_ahead_is_told_where_it_is(tmp_path: Path) -> None:
    lines = flight(2000)
    lines[1500:] = [line.replace(", ", ", 99", 1) for line in lines[1500:]]
    _, notes, _ = by_parts(flown(tmp_path, lines))
    assert any("its clock jumps by 99" in note and "at 14.990 s" in note for note in notes)


def test_a_column_that_held_numbers_is_one_to_the_end(tmp_path: Path) -> None:
    lines = [line.replace("-9.8", "-9.8" if k < 1200 else "none") for k, line in enumerate(flight(2000))]
    path = flown(tmp_path, lines)
    beside = path.parent / "vehicle.toml"
    beside.write_text(beside.read_text().replace('x = { column = "AccX"', 'x = { column = "AccZ"'))
    log, _, _ = by_parts(path)
    assert np.isfinite(log.value[:, 0]).sum() == 1200


def test_a_sensor_that_is_written_down_late_is_left_out_and_said(tmp_path: Path) -> None:
    lines = [imu(10_000 * k, k) + (f"BARO, {10_000 * (k - 900)}, {k}, 9e4\n" if k > 900 else "") for k in range(4000)]
    log, notes, _ = by_parts(flown(tmp_path, lines))
    assert log.fresh[:, 0].all()
    said = next(note for note in notes if "come much later" in note)
    assert said.startswith("flight.log (BARO): 3099 rows (first row 1) come")
