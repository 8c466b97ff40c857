"""An odd cell or line costs itself, not the file: it is left out and counted, and the first one is named."""

from pathlib import Path

import numpy as np
import pytest

from sensorfault.logs import Log, LogError, VehicleFile, guess, read

ONE = '[file.log]\ntime = "t"\n[sensor.s.channel]\na = { column = "a", unit = "m/s" }\n'


def put(folder: Path, content: str) -> Path:
    path = folder / "log.csv"
    path.write_bytes(content.encode())
    return path


def rows(count: int = 40, **changed: str) -> list[str]:
    lines = [f"{k},{k % 5}.5" for k in range(count)]
    for key, line in changed.items():
        lines[int(key[1:])] = line
    return lines


def log_of(folder: Path, lines: list[str], head: str = "t,a\n") -> Log:
    return read(put(folder, head + "\n".join(lines) + "\n"), VehicleFile.parse(ONE))


def test_a_cell_that_is_no_number_is_no_value(tmp_path: Path) -> None:
    log = log_of(tmp_path, rows(k30="30,broken"))
    np.testing.assert_array_equal(np.flatnonzero(np.isnan(log.value[:, 0])), [30])
    assert any("in 'a' (1), first 'broken' in line 32; read as no value" in note for note in log.notes)


def test_a_row_whose_time_is_no_number_is_left_out(tmp_path: Path) -> None:
    log = log_of(tmp_path, rows(k20="2O,0.5"))
    np.testing.assert_array_equal(log.time, [float(k) for k in range(40) if k != 20])
    assert any("first '2O' in line 22" in note for note in log.notes)


def test_a_line_with_too_many_cells_is_left_out(tmp_path: Path) -> None:
    log = log_of(tmp_path, rows(k20="20,0.5,7"))
    assert 20.0 not in log.time
    assert any("1 line left out: line 22 has 3 cells where the others have 2" in note for note in log.notes)


def test_many_lines_with_too_many_cells_are_refused(tmp_path: Path) -> None:
    lines = [f"{line},7" if k % 3 == 0 else line for k, line in enumerate(rows())]
    with pytest.raises(LogError, match="line 2 has 3 cells where the others have 2, and so do 14 of 41 lines"):
        log_of(tmp_path, lines)


def test_a_header_again_and_a_sum_are_no_rows(tmp_path: Path) -> None:
    lines = [*rows(20), "t,a", *rows(40)[20:], "Sum,all"]
    log = log_of(tmp_path, lines)
    np.testing.assert_array_equal(log.time, np.arange(40.0))
    assert np.isfinite(log.value).all()
    assert any("2 lines without numbers left out, first line 22 ('t')" in note for note in log.notes)


def test_lines_are_counted_with_blank_lines_comments_and_line_breaks_in_cells(tmp_path: Path) -> None:
    lines = [f'{k},{k % 5}.5,"two\nlines"' for k in range(30)]
    lines[25] = "25,broken,x"
    body = "\n".join(["# made by hand", "", "t,a,said", *lines[:3], "", "# a remark", *lines[3:]])
    log = read(put(tmp_path, body + "\n"), VehicleFile.parse(ONE))
    where = body.split("\n").index("25,broken,x") + 1
    assert any(f"first 'broken' in line {where};" in note for note in log.notes)
    assert len(log) == 30


def test_one_bad_date_costs_its_row(tmp_path: Path) -> None:
    stamps = [f"2026-11-23T12:00:{k:02d}" for k in range(50)]
    stamps[30] = "2026-11-23T12:O0:30"
    log = read(put(tmp_path, "time,ax\n" + "".join(f"{stamp},{k % 7}.5\n" for k, stamp in enumerate(stamps))))
    assert len(log) == 49
    assert any("1 row without a time" in note and "'2026-11-23T12:O0:30' in line 32" in note for note in log.notes)


def test_infinity_as_a_sign_is_no_value_where_nobody_needs_it(tmp_path: Path) -> None:
    path = put(
        tmp_path, "t,ax,cost\n" + "".join(f"{k},{k % 7}.5,{'∞' if k == 9 else k % 3 + 0.5}\n" for k in range(40))
    )
    assert "cost" in {channel.column for sensor in guess(path).sensors for channel in sensor.channels}
    assert any("infinite in 'cost' (1), first in line 11" in note for note in read(path).notes)
