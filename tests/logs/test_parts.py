"""A log read part by part is the log read whole."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fitted
from logs import written_bus
from logs.written_ros import bag1, bag2
from sensorfault.logs import Log, LogError, guess, read, write
from sensorfault.logs.describing import GUESSED
from sensorfault.logs.parts import is_long_log, read_parts
from sensorfault.logs.readers import beginning, can_bus, csv, mdf, mdf_load, parquet, topics
from sensorfault.logs.readers.formats import read_tables
from sensorfault.logs.readers.subprocess_reader import Loaded


@pytest.fixture(autouse=True)
def small_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(csv, "_PART_BYTES", 40_000)
    monkeypatch.setattr(parquet, "PART", 5000)
    monkeypatch.setattr(topics, "PART", 2000)


def parts_of(path: Path) -> list[Log]:
    parts: list[Log] = []
    read_parts(path, parts.append)
    return parts


def assert_whole(path: Path) -> None:
    whole, parts = read(path), parts_of(path)
    assert len(parts) > 5
    assert all(part.channels == whole.channels and part.epoch_s == pytest.approx(whole.epoch_s) for part in parts)
    np.testing.assert_allclose(np.concatenate([part.time for part in parts]), whole.time, atol=1e-6)
    np.testing.assert_array_equal(np.concatenate([part.value for part in parts]), whole.value)
    np.testing.assert_array_equal(np.concatenate([part.fresh for part in parts]), whole.fresh)


def recorded(folder: Path, way: str, seconds: float) -> Path:
    if way == "bag":
        return bag1(folder / "drive.bag", seconds=seconds)
    return bag2(folder / "drive", way == "mcap", seconds)


@pytest.mark.parametrize("name", ["drive.csv", "drive.parquet", "blanks.txt"])
def test_a_table_with_held_and_missing_values(tmp_path: Path, name: str) -> None:
    log = fitted.rig().between(end_s=60.0)
    value = log.value.copy()
    value[700:760, 6:] = np.nan  # a receiver that is silent for longer than a part
    log = replace(log, value=value, fresh=log.fresh & np.isfinite(value))
    path = tmp_path / name
    if path.suffix == ".txt":
        write(log, tmp_path / "drive.csv")
        text = (tmp_path / "drive.csv").read_text().replace(",,", ",NA,").replace(",\n", ",NA\n").replace(",,", ",NA,")
        path.write_text(text.replace(",", "  "))
        beside = (tmp_path / "drive.vehicle.toml").read_text().replace("drive.csv", name)
        path.with_suffix(".vehicle.toml").write_text(beside)
    else:
        write(log, path)
    assert_whole(path)


@pytest.mark.parametrize("way", ["bag", "db3", "mcap"])
def test_topics_of_several_rates(tmp_path: Path, way: str) -> None:
    path = recorded(tmp_path, way, 8.0)
    path.with_suffix(".vehicle.toml").write_text(guess(path).to_toml())
    assert_whole(path)


@pytest.mark.parametrize("write", [written_bus.blf, written_bus.asc])
def test_a_can_recording_with_frames_that_cannot_be_decoded(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, write: Callable[..., Path]
) -> None:
    monkeypatch.setattr(can_bus, "PART", 300)
    path = write(tmp_path / ("drive.blf" if write is written_bus.blf else "drive.asc"), 300)
    path.with_suffix(".vehicle.toml").write_text(guess(path).to_toml())
    assert_whole(path)
    said = read_parts(path, lambda part: None).notes
    assert "300 frames of unknown messages left out: 0x300" in " ".join(said)


@pytest.mark.parametrize("compression", [0, 2])
def test_groups_of_an_mdf_file_that_come_at_rates_of_their_own(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, compression: int
) -> None:
    path = written_bus.mdf(tmp_path / "drive.mf4", 500, compression)
    path.with_suffix(".vehicle.toml").write_text(guess(path).to_toml())
    whole = read(path)
    monkeypatch.setattr(mdf_load, "PART", 200)
    monkeypatch.setattr(mdf, "load_apart", lambda loader, file, part: mdf_load.load(str(file), part))
    assert_whole(path)
    assert len(whole) == 500


def test_an_mdf_file_is_read_up_to_the_part_at_which_its_library_ends(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = written_bus.mdf(tmp_path / "drive.mf4", 500)
    path.with_suffix(".vehicle.toml").write_text(guess(path).to_toml())

    def load(loader: str, file: Path, part: int) -> Loaded:
        if part == 3:
            raise ValueError("its sizes and types contradict each other")
        return mdf_load.load(str(file), part)

    monkeypatch.setattr(mdf_load, "PART", 200)
    monkeypatch.setattr(mdf, "load_apart", load)
    parts: list[Log] = []
    (said,) = read_parts(path, parts.append).damage
    assert said.startswith("drive.mf4: the file cannot be read further (its sizes and types contradict each other)")
    assert "at part 4 of 11; what came before was read." in said
    assert parts[-1].time[-1] == pytest.approx(9.98 * 3 / 11, abs=0.03)


def test_a_topic_that_falls_silent_is_there_without_values(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    log = fitted.rig().between(end_s=40.0)
    value = np.where((log.time > 10)[:, None] & (np.arange(8) >= 6), np.nan, log.value)
    beside = write(replace(log, value=value, fresh=log.fresh & np.isfinite(value)), path)
    result = beside.read_text().splitlines()
    beside.write_text("\n".join(line for line in result if not line.startswith("period_s")))
    assert all(np.isnan(part.value[:, 6:]).all() for part in parts_of(path)[4:])


def test_a_cut_file_is_read_as_far_as_it_is_whole(tmp_path: Path) -> None:
    path = bag1(tmp_path / "drive.bag", seconds=8.0)
    path.with_suffix(".vehicle.toml").write_text(guess(path).to_toml())
    path.write_bytes(path.read_bytes()[:-50_000])
    whole, parts = read(path), []
    said = read_parts(path, parts.append)
    assert set(whole.damage) == set(said.damage) <= set(said.notes)
    assert parts[-1].time[-1] == pytest.approx(whole.time[-1], abs=1e-6)


def test_what_cannot_be_read_in_parts_is_a_sentence(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    with pytest.raises(LogError, match="there is no such file or folder"):
        read_parts(path, print)
    (tmp_path / "log.tar.gz").write_bytes(b"x")
    with pytest.raises(LogError, match="an archive of several files; unpack it"):
        read_parts(tmp_path / "log.tar.gz", print)
    (tmp_path / "log.tar.gz").unlink()
    (tmp_path / "log.mat").write_bytes(b"x")
    with pytest.raises(LogError, match="this is MATLAB, which is read whole"):
        read_parts(tmp_path / "log.mat", print)
    write(fitted.rig().between(end_s=2.0), path)
    with pytest.raises(
        LogError, match=r"this is 2 files; .* one file of a format .*: ArduPilot DataFlash, .*, text table"
    ):
        read_parts(tmp_path, print)
    (tmp_path / "log.mat").unlink()
    lines = path.read_text().splitlines(keepends=True)
    path.write_text(lines[0] + lines[1])
    with pytest.raises(LogError, match="one row is no log"):
        read_parts(path, print)


def test_without_a_vehicle_file_columns_are_guessed(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    write(fitted.rig().between(end_s=60.0), path).unlink()
    assert_whole(path)
    assert GUESSED in read_parts(path, len).notes


def test_a_folder_of_one_recording_is_that_recording(tmp_path: Path) -> None:
    path = bag2(tmp_path / "drive", True, 8.0)
    whole, parts = read(path), []
    read_parts(path.parent, parts.append)
    np.testing.assert_array_equal(np.concatenate([part.value for part in parts]), whole.value)


@pytest.mark.parametrize("way", ["bag", "db3", "mcap"])
def test_an_error_of_whoever_takes_the_parts_comes_through(tmp_path: Path, way: str) -> None:
    def refuse(part: Log) -> None:
        raise LogError("no.")

    path = recorded(tmp_path, way, 8.0)
    with pytest.raises(LogError, match=r"^no\.$"):
        read_parts(path, refuse)


@pytest.mark.parametrize("way", ["csv", "bag", "db3", "mcap"])
def test_a_long_log_is_guessed_from_its_beginning(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, way: str) -> None:
    if way == "csv":
        path = tmp_path / "drive.csv"
        write(fitted.rig().between(end_s=120.0), path).unlink()
    else:
        path = recorded(tmp_path, way, 20.0)
    whole = guess(path)
    assert not is_long_log(path)
    monkeypatch.setattr(beginning, "LONG", path.stat().st_size - 1)
    assert is_long_log(path)
    seen = sum(len(one.frame) for one in beginning.read_beginning(path).values())
    assert seen < 0.9 * sum(len(one.frame) for one in read_tables(path).values())
    found = guess(path)
    assert found.files == whole.files
    assert len(found.sensors) == len(whole.sensors)  # what of them is constant, or wraps, shows in the whole alone
    assert {note for note in whole.notes if "topics" in note} <= set(found.notes)
    assert any("only its beginning was examined" in note for note in found.notes)


@pytest.mark.parametrize("way", ["blf", "asc", "mf4"])
def test_of_a_long_recording_of_a_car_only_the_beginning_is_looked_at(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, way: str
) -> None:
    write_it = {"blf": written_bus.blf, "asc": written_bus.asc, "mf4": written_bus.mdf}[way]
    path = write_it(tmp_path / f"drive.{way}", 300)
    monkeypatch.setattr(can_bus, "PART", 100)
    monkeypatch.setattr(mdf_load, "PART", 100)
    monkeypatch.setattr(mdf, "load_apart", lambda loader, file, part: mdf_load.load(str(file), part))
    rows = {name: len(one.frame) for name, one in beginning.read_beginning(path).items()}
    whole = {name: len(one.frame) for name, one in read_tables(path).items()}
    assert rows.keys() == whole.keys()
    assert all(0 < rows[name] < 0.8 * whole[name] for name in whole)


def test_the_parts_of_a_bag_are_long_together(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    only = bag2(tmp_path / "drive", True, 2.0)
    first = only.rename(only.with_name("drive_0.mcap"))
    first.with_name("drive_1.mcap").write_bytes(first.read_bytes())
    monkeypatch.setattr(beginning, "LONG", first.stat().st_size)
    assert is_long_log(first.parent)
