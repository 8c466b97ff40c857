"""Times in all forms that people write, and columns that rise but are no time."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import polars as pl
import pytest

from logs.small_parts import small_parts
from sensorfault.logs import Log, LogError, VehicleFile, guess, read
from sensorfault.logs.dates import form_of, microseconds
from sensorfault.logs.parts import read_parts

ROWS = 40
STEP_S = 0.1
WAVE = [f"{np.sin(k / 3):.3f}" for k in range(ROWS)]
NOON_S = 1_714_557_600.0  # 2024-05-01 10:00


def log_of(folder: Path, head: str, lines: list[str], name: str = "log.csv") -> Log:
    return read(put(folder, head, lines, name))


def put(folder: Path, head: str, lines: list[str], name: str = "log.csv") -> Path:
    path = folder / name
    path.write_text(head + "\n" + "\n".join(lines) + "\n")
    return path


def times(form: Callable[[int], str], step: int = 1) -> list[str]:
    """`form` of tenths of a second."""
    return [f"{form(k * step)},{WAVE[k]}" for k in range(ROWS)]


def clock(k: int) -> str:
    return f"10:00:{k // 10:02d}.{k % 10}"


FORMS: dict[str, Callable[[int], str]] = {
    "2024-05-01T": lambda k: f"2024-05-01T{clock(k)}",
    "without a fraction at whole seconds": lambda k: f"2024-05-01T{clock(k)}".removesuffix(".0"),
    "zone": lambda k: f"2024-05-01 12:00:{k // 10:02d}.{k % 10}+02:00",
    "month first": lambda k: f"05/01/2024 {clock(k)}",
    "AM": lambda k: f"5/1/2024 {clock(k)} AM",
    "dots": lambda k: f"01.05.2024 {clock(k)}",
    "two digits of the year": lambda k: f"01.05.24 {clock(k)}",
    "year first": lambda k: f"2024/05/01 {clock(k)}",
    "compact": lambda k: f"20240501T1000{k // 10:02d}.{k % 10}",
    "digits alone": lambda k: f"202405011000{k // 10:02d}.{k % 10}",
    "month by name": lambda k: f"01-May-2024 {clock(k)}",
    "as Java writes it": lambda k: f"Wed May 01 10:00:{k // 10:02d}.{k % 10} GMT 2024",
    "days since 1900": lambda k: f"{45413 + (36000 + k / 10) / 86400:.10f}",
    "days since the year 0": lambda k: f"{739373 + (36000 + k / 10) / 86400:.10f}",
    "Unix s": lambda k: f"{NOON_S + k / 10:.1f}",
    "Unix ms": lambda k: f"{round(NOON_S * 1000) + 100 * k}",
    "Unix us": lambda k: f"{round(NOON_S * 10**6) + 10**5 * k}",
    "Unix ns": lambda k: f"{round(NOON_S) * 10**9 + 10**8 * k}",
}


@pytest.mark.parametrize("form", FORMS)
def test_a_time_in_any_form(tmp_path: Path, form: str) -> None:
    log = log_of(tmp_path, "time,ax", times(FORMS[form]))
    np.testing.assert_allclose(log.time, np.arange(ROWS) * STEP_S, atol=2e-5)
    assert log.epoch_s == pytest.approx(NOON_S, abs=1e-3)


def test_a_clock_without_a_date_is_not_unix_time(tmp_path: Path) -> None:
    log = log_of(tmp_path, "time,ax", times(clock))
    np.testing.assert_allclose(log.time, np.arange(ROWS) * STEP_S, atol=1e-6)
    assert log.epoch_s is None


@pytest.mark.parametrize(
    ("head", "form"),
    [
        ("Date,Time,ax", lambda k: f"2024-05-01,{clock(k)}"),
        ("date,time,ax", lambda k: f"01.05.2024,{clock(k)}"),
        ("Date,Time,ax", lambda k: f"20240501,{clock(k)}"),
        ("header.stamp.secs,header.stamp.nsecs,ax", lambda k: f"{round(NOON_S) + k // 10},{k % 10 * 10**8}"),
        ("tv_sec,tv_usec,ax", lambda k: f"{round(NOON_S) + k // 10},{k % 10 * 10**5}"),
        ("gps_week,gps_tow,ax", lambda k: f"2312,{295218 + k / 10:.1f}"),
    ],
)
def test_a_time_in_two_columns(tmp_path: Path, head: str, form: Callable[[int], str]) -> None:
    path = put(tmp_path, head, times(form))
    log = read(path)
    np.testing.assert_allclose(log.time, np.arange(ROWS) * STEP_S, atol=1e-6)
    assert log.epoch_s == pytest.approx(NOON_S, abs=1e-3)
    vehicle = guess(path)
    assert VehicleFile.parse(vehicle.to_toml()) == vehicle
    np.testing.assert_array_equal(read(path, VehicleFile.parse(vehicle.to_toml())).time, log.time)


@pytest.mark.parametrize(("days", "format"), [(("12", "13"), "%d/%m/%Y"), (("01", "02"), "%d/%m/%Y")])
def test_day_first_or_month_first_is_decided_over_the_whole_column(days: tuple[str, str], format: str) -> None:
    cells = [f"{days[0]}/05/2024 23:59:59", f"{days[1]}/05/2024 00:00:00"]
    form = form_of(pl.Series(cells))
    assert form is not None
    assert form.format.startswith(format)
    assert not form.other
    assert microseconds(pl.Series(cells), form.format).diff()[1] == 10**6


def test_a_date_that_can_be_read_in_two_ways_is_said(tmp_path: Path) -> None:
    log = log_of(tmp_path, "time,ax", times(FORMS["month first"]))
    assert any("'time' is read as %m/%d/%Y" in note and "%d/%m/%Y" in note for note in log.notes)


@pytest.mark.parametrize(
    "column",
    [
        ("", lambda k: str(k)),
        ("Packet number", lambda k: str(114 + 2 * k + k % 2)),
        ("odometer_m", lambda k: f"{1.2 * k:.1f}"),
        ("longitude", lambda k: f"{11.5 + 1e-5 * k:.6f}"),
        ("lon_e7", lambda k: str(1_150_000_000 + 100 * k)),
        ("id", lambda k: str(1_700_000_000 + 7 * k * k)),
    ],
    ids=["row index", "packets", "odometer", "longitude", "longitude e7", "id"],
)
def test_what_rises_is_no_clock(tmp_path: Path, column: tuple[str, Callable[[int], str]]) -> None:
    name, cell = column
    with pytest.raises(LogError, match=r"there is no time column: "):
        guess(put(tmp_path, f"{name},ax", [f"{cell(k)},{WAVE[k]}" for k in range(ROWS)]))
    lines = [f"{cell(k)},{clock(k)},{WAVE[k]}" for k in range(ROWS)]
    assert guess(put(tmp_path, f"{name},time,ax", lines)).files[0].time == "time"


def test_a_time_that_cannot_be_read_is_named_and_nothing_stands_in_for_it(tmp_path: Path) -> None:
    lines = [f"tick{'x' * k},{1_700_000_000 + k / 10:.1f},{WAVE[k]}" for k in range(ROWS)]
    with pytest.raises(LogError, match=r"line 2, column 'time' holds 'tick', .* 10:00:00\.1; .*"):
        guess(put(tmp_path, "time,x,ax", lines))


def test_a_clock_in_whole_seconds_is_spread(tmp_path: Path) -> None:
    lines = [f"2024-05-01T10:00:{(k + 4) // 10:02d},{WAVE[k % ROWS]}" for k in range(300)]
    lines = [line.replace("10:00:", f"10:{(k + 4) // 600:02d}:") for k, line in enumerate(lines)]
    log = log_of(tmp_path, "time,ax", lines)
    np.testing.assert_allclose(log.time, np.arange(300) * STEP_S, atol=1e-6)
    assert any("about 10 rows for each reading" in note for note in log.notes)


@pytest.mark.parametrize("unit", ["furlong", "s+h"])
def test_a_unit_that_is_none(unit: str) -> None:
    with pytest.raises(LogError, match=rf"unit = '{unit.replace('+', '.')}' is no unit of time"):
        VehicleFile.parse(f'[file.log]\ntime = "t"\nunit = "{unit}"\n[sensor.s.channel]\na = {{ column = "a" }}')


def test_a_second_column_needs_a_unit_with_two_parts() -> None:
    with pytest.raises(LogError, match="the key fine belongs to the units s"):
        VehicleFile.parse('[file.log]\ntime = "t"\nfine = "u"\n[sensor.s.channel]\na = { column = "a" }')
    with pytest.raises(LogError, match="the key fine belongs to the units s"):
        VehicleFile.parse('[file.log]\ntime = "t"\nunit = "s+ns"\n[sensor.s.channel]\na = { column = "a" }')


def packets(folder: Path) -> Path:
    lines = [f"{114 + 2 * k},{WAVE[k]},{k % 5}.5" for k in range(ROWS)]
    return put(folder, "Packet number,Gyroscope X (deg/s),Accelerometer X (g)", lines, "packets.csv")


def test_a_table_without_a_clock_has_the_rate_that_is_given(tmp_path: Path) -> None:
    path = packets(tmp_path)
    log = read(path, rate_hz=50.0)
    np.testing.assert_allclose(log.time, np.arange(ROWS) / 50)
    assert log.epoch_s is None
    assert any("its rows are taken as 50 a second, as given" in note for note in log.notes)
    vehicle = VehicleFile.parse(guess(path, rate_hz=50.0).to_toml())
    assert vehicle.files[0].rate_hz == 50.0
    np.testing.assert_array_equal(read(path, vehicle).time, log.time)
    assert read(path, vehicle, rate_hz=25.0).period_s == pytest.approx(0.04)


def test_a_table_in_memory_may_have_a_rate(tmp_path: Path) -> None:
    table = {"ax": [float(cell) for cell in WAVE], "ay": [k % 5 + 0.5 for k in range(ROWS)]}
    assert read(table, rate_hz=20.0).period_s == pytest.approx(0.05)


def test_parts_of_a_table_without_a_clock_follow_each_other(tmp_path: Path) -> None:
    lines = [f"{114 + 2 * k},{np.sin(k / 3):.3f}" for k in range(3000)]
    path = put(tmp_path, "Packet number,ax", lines)
    parts: list[Log] = []
    with small_parts(100):
        read_parts(path, parts.append, rate_hz=100.0)
    assert len(parts) > 2
    np.testing.assert_allclose(np.concatenate([part.time for part in parts]), np.arange(3000) / 100, atol=1e-9)


@pytest.mark.parametrize(
    ("rate", "said"), [(0.0, "a positive number"), (-1.0, "a positive number"), (float("nan"), "positive")]
)
def test_a_rate_that_is_none(tmp_path: Path, rate: float, said: str) -> None:
    with pytest.raises(LogError, match=said):
        read(packets(tmp_path), rate_hz=rate)


def test_a_rate_beside_a_clock_is_refused(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="its clock is the column 'time'; leave out the rate"):
        read(put(tmp_path, "time,ax", times(clock)), rate_hz=10.0)


@pytest.mark.parametrize(("zero", "unit"), [(116_444_736_000_000_000, "filetime"), (0, "unix100ns")])
def test_ticks_of_100_ns(tmp_path: Path, zero: int, unit: str) -> None:
    path = tmp_path / "log.csv"
    ticks = zero + 17_145_576_000_000_000 + 200_000 * np.arange(400)
    path.write_text("timestamp,ax\n" + "".join(f"{t},{k % 7}.5\n" for k, t in enumerate(ticks)))
    log = read(path)
    assert log.time[-1] == pytest.approx(399 * 0.02)
    assert guess(path).files[0].unit == unit
