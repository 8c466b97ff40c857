"""What a car's bus and its measurement files hold, and each bad one as one sentence."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from asammdf import MDF, Signal

from logs import written_bus
from sensorfault.logs import Log, LogError, guess, read
from sensorfault.logs.readers import mdf_load
from sensorfault.logs.readers.subprocess_reader import load_apart


def column(log: Log, path: str) -> np.ndarray:
    return log.value[:, log.index(path)]


def test_groups_of_an_mdf_file_are_tables_with_clocks_of_their_own(tmp_path: Path) -> None:
    path = written_bus.mdf(tmp_path / "drive.mf4")
    assert {file.table for file in guess(path).files} == {"imu", "wheel"}
    log = read(path)
    assert len(log) == written_bus.ROWS
    time = np.arange(written_bus.ROWS) / 50
    np.testing.assert_allclose(column(log, "accelerometer.x"), np.sin(time))
    fresh = log.fresh[:, log.index("speed.speed")]
    np.testing.assert_array_equal(np.flatnonzero(fresh), np.arange(0, written_bus.ROWS, 5))
    np.testing.assert_allclose(column(log, "speed.speed")[fresh], (36 + time[::5]) / 3.6)
    assert any("1 channel of texts or arrays left out" in note for note in log.notes)


def test_the_process_that_reads_mdf_is_asked_for_stretches_of_time(tmp_path: Path) -> None:
    loaded = load_apart("mdf_load", written_bus.mdf(tmp_path / "drive.mf4"), 0)
    assert loaded.result["parts"] == 1
    assert len(loaded.vectors["imu"]["ax"]) == written_bus.ROWS


def test_a_channel_with_fewer_values_than_its_clock_costs_its_group(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = MDF(written_bus.mdf(tmp_path / "drive.mf4"))
    whole = file.get

    def get(**asked: Any) -> Signal:
        signal = whole(**asked)
        return Signal(signal.samples[:3], signal.timestamps[:3], name="speed") if signal.name == "speed" else signal

    monkeypatch.setattr(file, "get", get)
    monkeypatch.setattr(mdf_load, "_mdf", lambda path: file)
    loaded = mdf_load.load(str(tmp_path / "drive.mf4"))
    assert loaded.vectors.keys() == {"imu"}
    assert loaded.result["lost"] == [["wheel", "its channel 'speed' has not as many values as its clock"]]


@pytest.mark.parametrize("write", [written_bus.blf, written_bus.asc])
def test_frames_are_decoded_by_the_database_beside_them(tmp_path: Path, write: object) -> None:
    assert callable(write)
    log = read(write(tmp_path / ("drive.blf" if write is written_bus.blf else "drive.asc")))
    assert len(log) == written_bus.ROWS
    left = column(log, "front_left.front_left")
    np.testing.assert_allclose(left * 3.6, 36 + 0.1 * np.arange(written_bus.ROWS), atol=0.006)
    turned = column(log, "gyro.z")
    assert np.nanmax(turned) == pytest.approx(np.deg2rad(3.0))
    assert any(f"{written_bus.ROWS} frames of unknown messages left out: 0x300" in note for note in log.notes)
    if write is written_bus.blf:
        assert log.epoch_s == pytest.approx(written_bus.START_S, abs=0.01)


def test_a_recording_without_a_database_says_what_it_needs(tmp_path: Path) -> None:
    path = written_bus.blf(tmp_path / "drive.blf")
    (tmp_path / "car.dbc").unlink()
    with pytest.raises(LogError, match=r"there is no \.dbc file beside it"):
        read(path)
    (tmp_path / "car.dbc").write_text("nothing of the kind")
    with pytest.raises(LogError, match=r"car\.dbc: this database cannot be read"):
        read(path)


@pytest.mark.parametrize(("library", "name"), [("asammdf", "drive.mf4"), ("can", "drive.blf")])
def test_a_library_that_is_not_there_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, library: str, name: str
) -> None:
    path = written_bus.mdf(tmp_path / name) if library == "asammdf" else written_bus.blf(tmp_path / name)
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(LogError, match=r"run `pip install 'sensorfault\[bus\]'`"):
        read(path)


def test_a_recording_that_breaks_off_is_read_as_far_as_it_goes(tmp_path: Path) -> None:
    path = written_bus.asc(tmp_path / "drive.asc")
    lines = path.read_text().splitlines(keepends=True)
    path.write_text("".join(lines[: len(lines) // 2]) + "broken line that ends the file")
    log = read(path)
    assert 20 < len(log) < 40
