"""A clock that jumps is named by detect, at the row where it does, and no sensor is."""

import json
from functools import cache
from pathlib import Path

import numpy as np
import polars as pl
import pytest

import sensorfault as sf
from cli.conftest import Run
from logs.small_parts import small_parts
from relations import drives

WEEKS_S = 1024 * 604_800.0


@cache
def driven() -> pl.DataFrame:
    """Two minutes of the tests' own car, angles in degrees."""
    log = drives.car(120.0)
    columns = {"time_s": 1.72e9 + log.time}
    for i, channel in enumerate(log.channels):
        angle = channel.unit == "rad" or channel.name in ("latitude", "longitude", "course")
        columns[channel.path] = np.degrees(log.value[:, i]) if angle else log.value[:, i]
    return pl.DataFrame(columns)


def put(folder: Path, back_s: float) -> Path:
    """The drive, whose clock is set back after 90 s."""
    table, path = driven(), folder / "drive.csv"
    back = np.where(np.arange(len(table)) >= len(table) * 3 // 4, back_s, 0.0)
    table.with_columns(pl.col("time_s") - pl.Series(back)).fill_nan(None).write_csv(path)
    return path


@pytest.mark.parametrize(("back_s", "words"), [(WEEKS_S, "back by 7168 days"), (5.0, "back by 5 s")])
def test_the_clock_is_named_and_no_sensor(back_s: float, words: str, run: Run, tmp_path: Path) -> None:
    path = put(tmp_path, back_s)
    said = run("detect", path, "--json", "found.json")
    assert said.code == 0
    (line,) = (line for line in said.out.splitlines() if "jump" in line)
    assert line.split()[:5] == ["1:30.00", "1:30.00", "clock", "all", "jump"]
    assert words in line
    (event,) = json.loads((tmp_path / "found.json").read_text())["events"]
    assert (event["subject"], event["sensor"], event["kind"]) == ("clock", "clock", "jump")
    assert event["peak_score"] == pytest.approx(-back_s, abs=1e-3)
    assert event["start_s"] == event["end_s"] == pytest.approx(90.0, abs=1e-3)
    (of_python,) = sf.detect(sf.read(path)).events
    assert of_python.as_dict() == event


def test_the_clock_is_named_part_by_part_too(run: Run, tmp_path: Path) -> None:
    path = put(tmp_path, WEEKS_S)
    with small_parts(5000):
        assert run("detect", path, "--by-parts", "--json", "found.json").code == 0
    found = json.loads((tmp_path / "found.json").read_text())
    assert [(one["sensor"], round(one["start_s"], 2)) for one in found["events"]] == [("clock", 90.0)]
    assert found["judged_s"][1] == pytest.approx(120.0, abs=0.1)


def test_a_method_of_a_paper_names_it_too(run: Run, tmp_path: Path) -> None:
    path = put(tmp_path, WEEKS_S)
    assert run("detect", path, "--method", "pca", "--json", "found.json").code == 0
    events = json.loads((tmp_path / "found.json").read_text())["events"]
    assert [one["kind"] for one in events if one["sensor"] == "clock"] == ["jump"]


@pytest.mark.parametrize("cut", ["the middle", "the end, within a row"])
def test_a_log_that_was_cut_accuses_nobody(cut: str, run: Run, tmp_path: Path) -> None:
    path = put(tmp_path, 0.0)
    content = path.read_bytes()
    lines = content.splitlines(keepends=True)
    path.write_bytes(b"".join(lines[:1000] + lines[1600:]) if cut == "the middle" else content[: len(content) * 4 // 5])
    said = run("detect", path, "--json", "found.json")
    assert said.code == 0
    assert json.loads((tmp_path / "found.json").read_text())["events"] == []
    assert ("no sensor is called missing" in said.err) == (cut == "the middle")
