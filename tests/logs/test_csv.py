import csv as standard_csv
from pathlib import Path

import numpy as np
import pytest

from sensorfault.logs import VehicleFile, read
from sensorfault.logs.readers.csv import read_csv

ROWS = [(0.0, 1.5, -2.0), (0.02, 1.25, -2.5), (0.04, 1e-3, 3e4)]
VEHICLE = """
[file.log]
time = "{time}"
[sensor.imu.channel]
a = {{ column = "{a}" }}
b = {{ column = "{b}" }}
"""


def expect(
    path: Path, columns: tuple[str, str, str] = ("time", "a", "b"), rows: list[tuple[float, ...]] = ROWS
) -> None:
    time, a, b = columns
    log = read(path, VehicleFile.parse(VEHICLE.format(time=time, a=a, b=b)))
    np.testing.assert_allclose(log.time, [row[0] - rows[0][0] for row in rows], atol=1e-12)
    np.testing.assert_array_equal(log.value, [row[1:] for row in rows])
    assert not any("left out" in note for note in log.notes)


@pytest.mark.parametrize("delimiter", [",", ";", "\t", " ", "   ", "|"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
@pytest.mark.parametrize("header", [True, False])
def test_every_delimiter_with_and_without_header(tmp_path: Path, delimiter: str, end: str, header: bool) -> None:
    lines = [delimiter.join(("time", "a", "b"))] if header else []
    lines += [delimiter.join(str(cell) for cell in row) for row in ROWS]
    path = tmp_path / "log.csv"
    path.write_text(end.join(lines) + end, newline="")
    expect(path, ("time", "a", "b") if header else ("c1", "c2", "c3"))


@pytest.mark.parametrize("header", ["time;a;b\n", ""])
def test_decimal_commas_everywhere_are_no_delimiters(tmp_path: Path, header: str) -> None:
    rows = [(k + 0.5, k + 0.25, k + 0.75) for k in range(30)]
    path = tmp_path / "log.csv"
    path.write_text(header + "\n".join(";".join(str(c).replace(".", ",") for c in row) for row in rows))
    expect(path, ("time", "a", "b") if header else ("c1", "c2", "c3"), rows)


def test_decimal_commas(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("time;a;b\n" + "\n".join(";".join(str(c).replace(".", ",") for c in row) for row in ROWS))
    expect(path)


@pytest.mark.parametrize(
    "header", ["# made by hand\n# time,a,b\n", "%time,a,b\n", "# by hand, on a Monday\ntime,a,b\n"]
)
def test_comments_and_a_header_that_is_one(tmp_path: Path, header: str) -> None:
    path = tmp_path / "log.csv"
    body = [",".join(str(cell) for cell in row) for row in ROWS]
    path.write_text(
        header + body[0] + "\n#a remark\n\n".replace("#", header[0] if header[0] in "#%" else "#") + "\n".join(body[1:])
    )
    expect(path)


def test_quotes_blanks_and_doubled_names(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text('"time", "a", "a"\n0, 1, 2\n"0.5", "3", "4"\n1.0 ,5 , 6\n')
    expect(path, ("time", "a", "a_2"), [(0, 1, 2), (0.5, 3, 4), (1, 5, 6)])


@pytest.mark.parametrize("header", ["time,a,b\n", ""])
def test_a_byte_order_mark_is_no_part_of_the_first_cell(tmp_path: Path, header: str) -> None:
    path = tmp_path / "log.csv"
    path.write_text(header + "\n".join(",".join(str(cell) for cell in row) for row in ROWS), encoding="utf-8-sig")
    expect(path, ("time", "a", "b") if header else ("c1", "c2", "c3"))


def test_a_line_cut_off_at_either_end_is_left_out_and_said(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    whole = [f"{k / 10},{k},{k + 1}" for k in range(20)]
    path.write_text("7,8\n" + "\n".join(whole) + "\n2.0,4")
    source = read_csv(path)
    assert len(source.frame) == 20
    assert len(source.notes) == 2
    assert all("cut off" in note for note in source.notes)


def test_a_whole_last_line_without_newline_stays(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("time,a\n0,1\n1,2\n2,3")
    assert len(read_csv(path).frame) == 3


def test_nanoseconds_since_1970_keep_every_digit(tmp_path: Path) -> None:
    first = 1_734_501_485_318_454_633
    stamps = [first, first + 100_000_001, first + 200_000_007]
    path = tmp_path / "log.csv"
    path.write_text("stamp,a\n" + "".join(f"{stamp},{k}\n" for k, stamp in enumerate(stamps)))
    log = read(
        path, VehicleFile.parse('[file.log]\ntime = "stamp"\nunit = "ns"\n[sensor.s.channel]\na = { column = "a" }')
    )
    np.testing.assert_allclose(log.time, [0.0, 0.100000001, 0.200000007], rtol=0, atol=1e-12)
    assert log.epoch_s == pytest.approx(first / 1e9, abs=1e-6)


@pytest.mark.parametrize("late", ["7", "7.5", "1e3", " 7 ", "NA", "nan", "", "null", "N/A"])
def test_cells_unlike_the_first_thousand(tmp_path: Path, late: str) -> None:
    path = tmp_path / "log.csv"
    rows = [[str(k), str(k % 7)] for k in range(3000)]
    rows[2500][1] = late
    path.write_text("time,a\n" + "\n".join(",".join(row) for row in rows) + "\n")
    log = read(path, VehicleFile.parse('[file.log]\ntime = "time"\n[sensor.s.channel]\na = { column = "a" }'))
    want = np.array(
        [float(row[1]) if row[1].strip() not in ("NA", "nan", "", "null", "N/A") else np.nan for row in rows]
    )
    np.testing.assert_array_equal(log.value[:, 0], want)
    np.testing.assert_array_equal(log.fresh[:, 0], np.isfinite(want))


def test_random_tables_against_the_standard_reader(tmp_path: Path) -> None:
    random = np.random.default_rng(3)
    for trial in range(10):
        path = tmp_path / f"log{trial}.csv"
        table = random.normal(size=(random.integers(2, 50), 3)) * 10.0 ** random.integers(-8, 8, 3)
        table[:, 0] = np.cumsum(random.uniform(0.01, 0.02, len(table)))
        with path.open("w", newline="") as file:
            writer = standard_csv.writer(file)
            writer.writerow(["time", "a", "b"])
            writer.writerows(table.tolist())
        with path.open(newline="") as file:
            rows = [tuple(float(cell) for cell in row) for row in list(standard_csv.reader(file))[1:]]
        expect(path, rows=rows)


@pytest.mark.parametrize("end", ["", "\n"])
def test_a_remark_may_be_the_last_line(tmp_path: Path, end: str) -> None:
    path = tmp_path / "log.csv"
    path.write_text("time,a,b\n" + "".join(f"{t},{a},{b}\n" for t, a, b in ROWS) + "# that was all" + end)
    expect(path)


def test_days_since_the_year_0_in_a_column_of_that_name(tmp_path: Path) -> None:
    path = tmp_path / "log.csv"
    path.write_text("datenum,a\n" + "".join(f"{739373.4166666667 + k / 864000:.10f},{k % 5}.5\n" for k in range(50)))
    log = read(path)
    np.testing.assert_allclose(log.time, np.arange(50) / 10, atol=1e-4)
    assert log.epoch_s == pytest.approx(1_714_557_600.0, abs=1e-3)
