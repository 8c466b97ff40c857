"""Tables without a time, and a file of times beside them."""

from pathlib import Path

import numpy as np
import pytest

from sensorfault.logs import LogError, guess, read

STATE = np.random.default_rng(5).normal(0, 1, (200, 3)).round(4)
TIME_S = 0.02 * np.arange(200)


def lay_out(folder: Path, times: np.ndarray = TIME_S, header: str = "") -> Path:
    np.savetxt(folder / "state.csv", STATE, delimiter=",")
    np.savetxt(folder / "command.csv", STATE[:-1] * 2, delimiter=",")
    np.savetxt(folder / "time.csv", times, fmt="%.6f", header=header, comments="")
    return folder


@pytest.mark.parametrize("header", ["", "time [s]"])
def test_a_folder_of_tables_is_one_log(tmp_path: Path, header: str) -> None:
    log = read(lay_out(tmp_path, header=header))
    assert {sensor.name for sensor in log.sensors} == {"state_c", "command_c"}
    np.testing.assert_allclose(log.time, TIME_S[:-1], atol=1e-9)
    np.testing.assert_array_equal(log.value[:, log.of("state_c")], STATE[:-1])
    np.testing.assert_array_equal(log.value[:, log.of("command_c")], STATE[:-1] * 2)
    assert log.name == tmp_path.name
    assert not any("time.csv" in note for note in log.notes)


def test_one_table_of_it(tmp_path: Path) -> None:
    log = read(lay_out(tmp_path) / "state.csv")
    np.testing.assert_allclose(log.time, TIME_S, atol=1e-9)
    vehicle = tmp_path / "vehicle.toml"
    vehicle.write_text(guess(tmp_path / "state.csv").to_toml())
    np.testing.assert_array_equal(read(tmp_path / "state.csv", vehicle).value, log.value)


def test_milliseconds(tmp_path: Path) -> None:
    log = read(lay_out(tmp_path, 1000 * TIME_S) / "state.csv")
    np.testing.assert_allclose(log.time, TIME_S, atol=1e-9)


def test_a_table_with_a_time_of_its_own_keeps_it(tmp_path: Path) -> None:
    lay_out(tmp_path, 7 + 5 * TIME_S)
    table = np.column_stack([TIME_S, STATE])
    np.savetxt(tmp_path / "own.csv", table, delimiter=",", header="stamp,a,b,c", comments="")
    log = read(tmp_path / "own.csv")
    np.testing.assert_allclose(log.time, TIME_S, atol=1e-9)


def test_as_many_times_as_rows(tmp_path: Path) -> None:
    lay_out(tmp_path, 0.02 * np.arange(202))
    with pytest.raises(LogError, match="there is no time column"):
        read(tmp_path / "state.csv")
    table = np.column_stack([TIME_S, STATE])
    np.savetxt(tmp_path / "state.csv", table, delimiter=",")
    log = read(tmp_path / "state.csv")
    np.testing.assert_allclose(log.time, TIME_S, atol=1e-9)
    assert any("time.csv has 202 times for 200 rows" in note for note in log.notes)


def test_a_line_that_is_no_time(tmp_path: Path) -> None:
    path = lay_out(tmp_path) / "time.csv"
    path.write_text(path.read_text().replace("3.960000", "late"))
    with pytest.raises(LogError, match=r"time\.csv: 'late' is not a time; write one number per line"):
        read(tmp_path / "state.csv")


def test_a_table_that_is_called_like_times_is_a_table(tmp_path: Path) -> None:
    path = tmp_path / "t.csv"
    np.savetxt(path, np.column_stack([TIME_S, STATE]), delimiter=",")
    assert read(path).value.shape == STATE.shape
    assert read(tmp_path).value.shape == STATE.shape
