"""Each bad input is one sentence that names the place and the mend."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import polars as pl
import pytest

from sensorfault.logs import LogError, VehicleFile, guess, read

ONE = '[file.log]\ntime = "t"\n[sensor.s.channel]\na = { column = "a", unit = "m/s" }\n'


def put(folder: Path, name: str, content: str | bytes) -> Path:
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def missing(folder: Path) -> Path:
    return folder / "nowhere.csv"


def empty(folder: Path) -> Path:
    return put(folder, "log.csv", "")


def blank(folder: Path) -> Path:
    return put(folder, "log.csv", "\n \n\n")


def comments(folder: Path) -> Path:
    return put(folder, "log.csv", "# nothing\n# here\n")


def header_only(folder: Path) -> Path:
    return put(folder, "log.csv", "t,a\n")


def one_row(folder: Path) -> Path:
    return put(folder, "log.csv", "t,a\n0,1\n")


def one_time(folder: Path) -> Path:
    return put(folder, "log.csv", "t,a\n5,1\n5,2\n5,3\n")


def one_column(folder: Path) -> Path:
    return put(folder, "log.csv", "t\n0\n1\n2\n")


def no_time(folder: Path) -> Path:
    random = np.random.default_rng(0)
    return put(folder, "log.csv", "b,a\n" + "".join(f"{x},{y}\n" for x, y in random.normal(size=(50, 2))))


def open_quote(folder: Path) -> Path:
    quote = '"'
    return put(folder, "log.csv", "t,a\n" + "".join(f"{k},{quote * (k == 20)}{k % 5}.5\n" for k in range(40)))


def all_nan(folder: Path) -> Path:
    return put(folder, "log.csv", "t,a\n" + "".join(f"{k},nan\n" for k in range(40)))


def backwards(folder: Path) -> Path:
    return put(folder, "log.csv", "t,a\n" + "".join(f"{(k * 37) % 100},{k % 5}.5\n" for k in range(100)))


def unknown_suffix(folder: Path) -> Path:
    return put(folder, "log.xlsx", "t,a\n0,1\n")


def no_suffix(folder: Path) -> Path:
    return put(folder, "log", "t,a\n0,1\n")


def binary(folder: Path) -> Path:
    return put(folder, "log.csv", np.random.default_rng(0).bytes(5000))


def binary_parquet(folder: Path) -> Path:
    return put(folder, "log.parquet", np.random.default_rng(0).bytes(5000))


def cut_parquet(folder: Path) -> Path:
    path = folder / "log.parquet"
    pl.DataFrame({"t": np.arange(500.0), "a": np.arange(500.0)}).write_parquet(path)
    return put(folder, "log.parquet", path.read_bytes()[:-40])


def empty_parquet(folder: Path) -> Path:
    pl.DataFrame({"t": [], "a": []}).write_parquet(folder / "log.parquet")
    return folder / "log.parquet"


def bad_pos(folder: Path) -> Path:
    return put(folder, "log.pos", "% program : RTKPOST\n2026/01/01 00:00:00.000 51.0 13.0 100.0 1 9\n")


def pos_without_rows(folder: Path) -> Path:
    return put(folder, "log.pos", "%  GPST  latitude(deg) longitude(deg) height(m)  Q  ns\n")


def torn_pos(folder: Path) -> Path:
    return put(folder, "log.pos", "% GPST latitude(deg)\n2026/01/01 00:00:00.0 51.0\nnonsense here too\n")


def folder_of_nothing(folder: Path) -> Path:
    put(folder, "photo.jpg", b"\xff\xd8")
    return folder


def folder_of_garbage(folder: Path) -> Path:
    binary(folder)
    put(folder, "b.csv", "")
    return folder


CASES: list[tuple[Callable[[Path], Path], str, str]] = [
    (missing, "there is no such file", "check the path"),
    (empty, "empty", "name a log"),
    (blank, "empty", "name a log"),
    (comments, "comments only", "name a log"),
    (header_only, "no row", "name a log"),
    (one_row, "one row", "at least two rows"),
    (one_time, "one row|stands still", "at least two rows|one row for each time"),
    (one_column, "one cell", "delimiter"),
    (no_time, "no time column", "add one|take one of"),
    (open_quote, "line 22 has a quote that does not close", "correct that line"),
    (all_nan, "column 'a' holds no value at all", "take it out"),
    (backwards, "goes back", "sort the file"),
    (unknown_suffix, r"'\.xlsx'", "give one of .asc, .bag, "),
    (no_suffix, "nothing here reads 'log'", "give one of .asc, .bag, "),
    (binary, "not text", "export"),
    (binary_parquet, "not a readable Parquet", "export"),
    (cut_parquet, "not a readable Parquet", "export"),
    (empty_parquet, "empty", "name a log"),
    (bad_pos, "no header line", "let RTKLIB"),
    (pos_without_rows, "no solution", "name a log"),
    (torn_pos, "do not fit the header", "let RTKLIB"),
    (folder_of_nothing, "no file in this folder", "put one of"),
]


def one_sentence(message: str) -> bool:
    return "\n" not in message and message.endswith((".", ")")) and "Traceback" not in message and len(message) < 600


@pytest.mark.parametrize(("make", "wrong", "mend"), CASES, ids=[case[0].__name__ for case in CASES])
def test_bad_input_is_one_sentence(tmp_path: Path, make: Callable[[Path], Path], wrong: str, mend: str) -> None:
    path = make(tmp_path)
    with pytest.raises(LogError, match=wrong) as raised:
        read(path, VehicleFile.parse(ONE))
    with pytest.raises(LogError, match=mend):
        read(path, VehicleFile.parse(ONE))
    assert one_sentence(str(raised.value))
    assert str(path) in str(raised.value)
    assert raised.value.__cause__ is None
    assert raised.value.__suppress_context__ or raised.value.__context__ is None


@pytest.mark.parametrize("make", [case[0] for case in CASES] + [folder_of_garbage])
def test_bad_input_is_one_sentence_without_a_vehicle_file_too(tmp_path: Path, make: Callable[[Path], Path]) -> None:
    path = make(tmp_path)
    for call in (read, guess):
        with pytest.raises(LogError) as raised:
            call(path)
        assert one_sentence(str(raised.value))
        assert str(path) in str(raised.value)


def test_no_time_column_is_said_when_guessing(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="there is no time column"):
        guess(no_time(tmp_path))


def test_infinite_and_empty_cells_are_no_values_and_said(tmp_path: Path) -> None:
    cells = [f"{k}.25" for k in range(20)]
    cells[4], cells[5], cells[9], cells[12] = "inf", "-inf", "", "NaN"
    path = put(tmp_path, "log.csv", "t,a\n" + "".join(f"{k},{cell}\n" for k, cell in enumerate(cells)))
    log = read(path, VehicleFile.parse(ONE))
    np.testing.assert_array_equal(np.flatnonzero(np.isnan(log.value[:, 0])), [4, 5, 9, 12])
    np.testing.assert_array_equal(log.fresh[:, 0], np.isfinite(log.value[:, 0]))
    infinite, none = log.notes
    assert "are infinite in 'a' (2), first in line 6" in infinite
    assert "are empty in 'a' (2), first in line 11" in none


def test_an_empty_column_is_left_out_of_a_guess(tmp_path: Path) -> None:
    path = put(tmp_path, "log.csv", "t,ax,ay\n" + "".join(f"{k / 10},,{k % 7}.5\n" for k in range(40)))
    assert [channel.column for sensor in guess(path).sensors for channel in sensor.channels] == ["ay"]


def test_a_silent_sensor_may_be_empty_if_its_period_is_known(tmp_path: Path) -> None:
    log = read(
        all_nan(tmp_path),
        VehicleFile.parse(ONE.replace("[sensor.s.channel]", "[sensor.s]\nperiod_s = 0.5\n[sensor.s.channel]")),
    )
    assert not log.fresh.any()
    assert log.sensors[0].period_s == 0.5


def test_a_column_that_is_not_there(tmp_path: Path) -> None:
    path = put(tmp_path, "log.csv", "t,b\n0,1\n1,2\n")
    with pytest.raises(LogError, match=r"no column 'a'; take one of t, b"):
        read(path, VehicleFile.parse(ONE))
