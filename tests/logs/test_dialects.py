"""Text tables as they are: quotes, units, preambles, several kinds of records."""

from pathlib import Path

import numpy as np
import pytest

from sensorfault.logs import LogError, guess, read
from sensorfault.logs.readers.csv import read_csv
from sensorfault.logs.readers.dialect import sniff
from sensorfault.logs.readers.formats import read_tables
from sensorfault.logs.readers.source import Source


def put(folder: Path, content: str | bytes, name: str = "log.csv") -> Path:
    path = folder / name
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


def table(folder: Path, content: str | bytes) -> Source:
    return read_csv(put(folder, content))


ROWS = "".join(f"{k / 10},{k % 5}.5,{k % 3}.25\n" for k in range(30))
TIME = np.arange(30) / 10


def check(source: Source, names: list[str]) -> None:
    assert source.frame.columns == names
    np.testing.assert_allclose(source.frame[names[0]].to_numpy(), TIME, atol=1e-12)
    np.testing.assert_array_equal(source.frame[names[1]].to_numpy(), [k % 5 + 0.5 for k in range(30)])
    np.testing.assert_array_equal(source.frame[names[2]].to_numpy(), [k % 3 + 0.25 for k in range(30)])


def test_quoted_names_with_commas_and_line_breaks(tmp_path: Path) -> None:
    check(
        table(tmp_path, f'time,"gyro, x","said ""twice""\nand again"\n{ROWS}'),
        ["time", "gyro, x", 'said "twice"\nand again'],
    )


@pytest.mark.parametrize("units", ["s,m/s^2,deg/s", "[s],[m/s^2],[deg/s]", "(s),(m/s^2),(deg/s)"])
def test_a_row_of_units(tmp_path: Path, units: str) -> None:
    source = table(tmp_path, f"time,ax,gyro_z\n{units}\n{ROWS}")
    check(source, ["time", "ax", "gyro_z"])
    assert source.units == {"time": "s", "ax": "m/s^2", "gyro_z": "deg/s"}
    assert {c.unit for s in guess(put(tmp_path, f"time,ax,gyro_z\n{units}\n{ROWS}")).sensors for c in s.channels} == {
        "m/s^2",
        "deg/s",
    }


def test_a_row_of_types(tmp_path: Path) -> None:
    check(table(tmp_path, f"time,ax,gyro_z\nfloat64,float64,double\n{ROWS}"), ["time", "ax", "gyro_z"])


def test_two_rows_of_names(tmp_path: Path) -> None:
    body = "".join(f"{k / 10},{k % 5}.5,{k % 3}.25\n" for k in range(30))
    check(table(tmp_path, f",Accelerometer,Gyroscope\ntime,X,X\n{body}"), ["time", "Accelerometer.X", "Gyroscope.X"])


@pytest.mark.parametrize(
    "preamble",
    [
        "// a logger\n// 100 Hz\n",
        "# a logger, version 2\n#\n",
        "% a logger\n",
        "Device: a logger\nRate: 100\n\n",
        "Device,a logger\nRate,100\n\n",
        "Rain\n",
    ],
)
def test_what_stands_above_the_names(tmp_path: Path, preamble: str) -> None:
    check(table(tmp_path, f"{preamble}time,ax,gyro_z\n{ROWS}"), ["time", "ax", "gyro_z"])


def test_a_delimiter_at_the_end_of_each_line(tmp_path: Path) -> None:
    check(table(tmp_path, "time,ax,gyro_z\n" + ROWS.replace("\n", ",\n")), ["time", "ax", "gyro_z"])
    check(table(tmp_path, "time,ax,gyro_z,\n" + ROWS.replace("\n", ",\n")), ["time", "ax", "gyro_z"])
    check(table(tmp_path, "time,ax,gyro_z,\n" + ROWS), ["time", "ax", "gyro_z"])


def test_numbered_rows_whose_numbers_have_no_name(tmp_path: Path) -> None:
    lines = "".join(f"{k + 1},{line}\n" for k, line in enumerate(ROWS.splitlines()))
    source = table(tmp_path, f"time,ax,gyro_z\n{lines}")
    check(Source(source.path, source.frame.drop("c1")), ["time", "ax", "gyro_z"])


def test_a_header_that_does_not_fit_its_rows_is_refused(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="the header has 4 names, but the rows have 3 cells"):
        table(tmp_path, f"time,gyro, x,ax\n{ROWS}")


@pytest.mark.parametrize("encoding", ["utf-16", "utf-8-sig", "cp1252"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_encodings_and_ends_of_lines(tmp_path: Path, encoding: str, end: str) -> None:
    content = f"time,ax,größe\n{ROWS}".replace("\n", end).encode(encoding)
    check(table(tmp_path, content), ["time", "ax", "größe"])


def test_a_header_of_more_than_64_kb(tmp_path: Path) -> None:
    names = [f"signal_{i:05d}_{'x' * 40}" for i in range(2000)]
    lines = [",".join([f"{k / 10}", *(f"{(k * i) % 7}.5" for i in range(2000))]) for k in range(5)]
    source = table(tmp_path, ",".join(["time", *names]) + "\n" + "\n".join(lines) + "\n")
    assert source.frame.columns == ["time", *names]
    assert len(source.frame) == 5


@pytest.mark.parametrize(
    ("separator", "cells", "values"),
    [
        (",", ['"1,234.5"', '"12,345,678.25"', "7.5"], [1234.5, 12345678.25, 7.5]),
        (";", ["1.234,5", "12.345.678,25", "7,5"], [1234.5, 12345678.25, 7.5]),
        (";", ["1'234.5", "12'345'678.25", "7.5"], [1234.5, 12345678.25, 7.5]),
        (";", ["1 234,5", "12 345 678,25", "7,5"], [1234.5, 12345678.25, 7.5]),
        (";", ["0,500", "1,500", "-2,750"], [0.5, 1.5, -2.75]),
    ],
)
def test_groups_of_digits(tmp_path: Path, separator: str, cells: list[str], values: list[float]) -> None:
    lines = [f"{k}{separator}{cells[k % 3]}" for k in range(30)]
    source = table(tmp_path, f"time{separator}a\n" + "\n".join(lines) + "\n")
    np.testing.assert_array_equal(source.frame["a"].to_numpy(), [values[k % 3] for k in range(30)])


def test_dotted_dates_beside_decimal_commas_are_no_numbers(tmp_path: Path) -> None:
    lines = [f"13.01.2024;10:00:{k:02d};{k},5" for k in range(30)]
    source = table(tmp_path, "Date;Time;a\n" + "\n".join(lines) + "\n")
    assert source.frame["Date"][0] == "13.01.2024"


def test_decimal_commas_between_blanks(tmp_path: Path) -> None:
    lines = [f"{k},5  {k % 5},25  {k % 3},125" for k in range(30)]
    source = table(tmp_path, "time  a  b\n" + "\n".join(lines) + "\n")
    assert source.frame.row(3) == (3.5, 3.25, 0.125)


def test_a_column_that_names_the_kind_of_each_row(tmp_path: Path) -> None:
    lines = []
    for k in range(60):
        lines.append(f"{k / 10},ACC,{k % 5}.5,{k % 3}.5,9.8")
        if k % 2 == 0:
            lines.append(f"{k / 10},GYR,0.{k % 7},0.{k % 3},0.1")
    path = put(tmp_path, "time,sensor,x,y,z\n" + "\n".join(lines) + "\n")
    tables = read_tables(path)
    assert {name: len(one.frame) for name, one in tables.items()} == {"ACC": 60, "GYR": 30}
    assert tables["GYR"].place(1) == "line 6"
    assert read(path).duration_s == pytest.approx(5.9)


def test_one_value_a_line_is_called_what_the_line_names(tmp_path: Path) -> None:
    lines = "".join(f"{k / 10},ax,{k % 5}.5\n{k / 10},speed,{k % 3}.25\n" for k in range(30))
    tables = read_tables(put(tmp_path, "time,name,value\n" + lines))
    assert {name: one.frame.columns for name, one in tables.items()} == {
        "ax": ["time", "ax"],
        "speed": ["time", "speed"],
    }
    np.testing.assert_array_equal(tables["ax"].frame["ax"].to_numpy(), [k % 5 + 0.5 for k in range(30)])
    assert {c.column for s in guess(tmp_path / "log.csv").sensors for c in s.channels} == {"ax", "speed"}


def test_a_mode_is_no_kind(tmp_path: Path) -> None:
    lines = [f"{k / 10},{'MANUAL' if k < 30 else 'AUTO'},{k % 5}.5" for k in range(60)]
    assert set(read_tables(put(tmp_path, "time,name,ax\n" + "\n".join(lines) + "\n"))) == {""}


def test_records_of_several_kinds_and_lengths(tmp_path: Path) -> None:
    lines = []
    for k in range(100):
        stamp = f"2022:06:01 13:42:{k // 10 + 5:02d}.{k % 10}00000"
        lines.append(f"IMU;{stamp};AngularVelocity;{k % 5}.5;0.25;0.125;Temperature;{20 + k % 3}")
        if k % 5 == 0:
            lines.append(f"GPS;{stamp};{51 + k * 1e-5:.6f};{5 + k * 1e-5:.6f}")
    path = put(tmp_path, "\n".join([*lines, "GPS;broken"]) + "\n")
    tables = read_tables(path)
    assert {name: len(one.frame) for name, one in tables.items()} == {"IMU": 100, "GPS": 20}
    assert tables["IMU"].frame.columns[1:] == [*(f"AngularVelocity.{axis}" for axis in "xyz"), "Temperature"]
    assert any("1 record unlike the others" in note for note in tables["GPS"].notes)
    assert read(path).period_s == pytest.approx(0.1)


def test_prose_is_no_table(tmp_path: Path) -> None:
    text = "\n".join("this is, " * (k % 7) + "a letter to no one; it has words." for k in range(60))
    with pytest.raises(LogError):
        read(put(tmp_path, text, "letter.txt"))


def test_names_in_a_comment_above_units_in_a_comment(tmp_path: Path) -> None:
    assert sniff(put(tmp_path, f"# time,ax,gyro_z\n# [s],[m/s^2],[deg/s]\n{ROWS}")).names == ("time", "ax", "gyro_z")
