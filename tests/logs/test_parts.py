"""A log read part by part is the log read whole."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import fitted
from logs.written_ros import bag1, bag2
from sensorfault.logs import Log, LogError, guess, read, write
from sensorfault.logs.parts import has_parts, read_parts
from sensorfault.logs.readers import csv, parquet, topics


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
    path = bag1(tmp_path / "drive.bag", seconds=8.0) if way == "bag" else bag2(tmp_path / "drive", way == "mcap", 8.0)
    path.with_suffix(".vehicle.toml").write_text(guess(path).to_toml())
    assert_whole(path)


def test_a_topic_that_falls_silent_is_there_without_values(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    log = fitted.rig().between(end_s=40.0)
    value = np.where((log.time > 10)[:, None] & (np.arange(8) >= 6), np.nan, log.value)
    beside = write(replace(log, value=value, fresh=log.fresh & np.isfinite(value)), path)
    told = beside.read_text().splitlines()
    beside.write_text("\n".join(line for line in told if not line.startswith("period_s")))
    assert all(np.isnan(part.value[:, 6:]).all() for part in parts_of(path)[4:])


def test_a_cut_file_is_read_as_far_as_it_is_whole(tmp_path: Path) -> None:
    path = bag1(tmp_path / "drive.bag", seconds=8.0)
    path.with_suffix(".vehicle.toml").write_text(guess(path).to_toml())
    path.write_bytes(path.read_bytes()[:-50_000])
    whole, parts = read(path), []
    said = read_parts(path, parts.append)
    assert set(whole.damage) <= set(said)
    assert parts[-1].time[-1] == pytest.approx(whole.time[-1], abs=1e-6)


def test_what_cannot_be_read_in_parts_is_a_sentence(tmp_path: Path) -> None:
    path = tmp_path / "drive.csv"
    with pytest.raises(LogError, match="this is a folder or nothing"):
        read_parts(path, print)
    path.write_text("time,a\n0,1\n1,2\n")
    with pytest.raises(LogError, match=r"needs a vehicle\.toml"):
        read_parts(path, print)
    assert not has_parts(path)
    (tmp_path / "log.mat").write_bytes(b"x")
    with pytest.raises(LogError, match="MATLAB, which is read whole"):
        read_parts(tmp_path / "log.mat", print)
    write(fitted.rig().between(end_s=2.0), path)
    assert has_parts(path)
    lines = path.read_text().splitlines(keepends=True)
    path.write_text(lines[0] + lines[1])
    with pytest.raises(LogError, match="one row is no log"):
        read_parts(path, print)
