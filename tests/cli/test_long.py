"""`detect` on a log that is read part by part."""

import json
import os
from pathlib import Path

import pytest

from cli.conftest import Run
from sensorfault.logs.readers import beginning, csv

NUMBERS = "measurements", "rate_hz", "held", "missing"


def test_by_parts_it_finds_the_same(run: Run, drive: Path, car: Path) -> None:
    assert run("init", drive).code == 0
    run("inject", drive, "--fault", "offset:accelerometer.x:40:5:9", "--out", "lying.csv")
    words = "detect", "lying.csv", "--model", car, "--json"
    whole = json.loads(run(*words, "-").out)
    said = run(*words, "-", "--by-parts", "--out", "events.jsonl")
    result = json.loads(said.out)
    assert "read part by part" in said.err
    assert [(e["sensor"], e["kind"]) for e in result["events"]] == [(e["sensor"], e["kind"]) for e in whole["events"]]
    assert result["events"]
    assert len(Path("events.jsonl").read_text().splitlines()) == len(whole["events"])
    assert result["judged_s"] == pytest.approx(whole["judged_s"], abs=1e-6)
    assert all(result[key] == whole[key] for key in whole.keys() - {"judged_s", "events"})


def test_a_long_file_is_read_by_parts_where_it_can_be(
    run: Run, drive: Path, car: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert "part by part" not in run("detect", drive, "--model", car).err
    monkeypatch.setattr(beginning, "LONG", 1000)
    assert "part by part" in run("detect", drive, "--model", car).err
    assert "part by part" not in run("detect", drive, "--model", car, "--whole").err


def test_by_parts_a_log_holds_the_same(run: Run, drive: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(csv, "_PART_BYTES", 50_000)
    whole, parts = (json.loads(run("info", drive, "--json", "-", way).out) for way in ("--whole", "--by-parts"))
    for key in ("duration_s", "tick_s"):
        assert parts.pop(key) == pytest.approx(whole.pop(key))
    for mine, theirs in zip(parts.pop("sensors"), whole.pop("sensors"), strict=True):
        assert [mine[key] for key in NUMBERS] == pytest.approx([theirs.pop(key) for key in NUMBERS], rel=1e-6)
        assert theirs.items() <= mine.items()
    assert parts == whole


def test_a_page_by_parts(run: Run, drive: Path, car: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(csv, "_PART_BYTES", 50_000)
    run("inject", drive, "--fault", "offset:accelerometer.x:40:5:9", "--out", "lying.csv")
    for verb, way in (("report", ()), ("detect", ("--report", "report.html"))):
        said = run(verb, "lying.csv", "--model", car, "--by-parts", *way)
        assert said.code == 0, said.err
        page = Path("report.html").read_text()
        assert "4,000 samples" in page
        assert "Limits: fitted by relative-conditioning on drive" in page
        Path("report.html").unlink()


def test_without_a_model_it_is_fitted_on_the_beginning(run: Run, drive: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(csv, "_PART_BYTES", 50_000)
    run("inject", drive, "--fault", "offset:accelerometer.x:60:5:9", "--out", "lying.csv")
    said = run("detect", "lying.csv", "--by-parts", "--method", "pca", "--json", "-", "--report", "page.html")
    assert "pca was fitted on 0:00.00 to" in said.err
    assert "assumed healthy" in Path("page.html").read_text()
    result = json.loads(said.out)
    assert 0 < result["fitted_on_s"][1] <= result["judged_s"][0] < 60
    assert ("accelerometer", "offset") in [(event["sensor"], event["kind"]) for event in result["events"]]


def test_what_is_larger_than_memory_is_a_sentence(run: Run, drive: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "sysconf", {"SC_PHYS_PAGES": 2, "SC_PAGE_SIZE": 4096}.get)
    answer = run("detect", drive)
    assert (answer.code, answer.out) == (2, "")
    assert "cannot be read whole in 8.19e-06 GB of memory" in answer.err
    monkeypatch.delattr(os, "sysconf")  # a system that has none
    assert run("info", drive).code == 0
