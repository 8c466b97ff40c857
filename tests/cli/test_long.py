"""`detect` on a log that is read part by part."""

import json
from pathlib import Path

import pytest

from cli.conftest import Run
from sensorfault.cli import long


def test_by_parts_it_finds_the_same(run: Run, drive: Path, car: Path) -> None:
    assert run("init", drive).code == 0
    run("inject", drive, "--fault", "bias:accelerometer.x:40:5:9", "--out", "lying.csv")
    words = "detect", "lying.csv", "--model", car, "--json"
    whole = json.loads(run(*words, "-").out)
    said = run(*words, "-", "--by-parts", "--out", "events.jsonl")
    told = json.loads(said.out)
    assert "read part by part" in said.err
    assert [(e["sensor"], e["kind"]) for e in told["events"]] == [(e["sensor"], e["kind"]) for e in whole["events"]]
    assert told["events"]
    assert len(Path("events.jsonl").read_text().splitlines()) == len(whole["events"])
    assert told["judged_s"] == pytest.approx(whole["judged_s"], abs=1e-6)


def test_a_large_file_is_read_by_parts_where_it_can_be(
    run: Run, drive: Path, car: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(long, "LARGE", 1000)
    assert "part by part" not in run("detect", drive, "--model", car).err  # nobody says what its columns are
    run("init", drive)
    assert "part by part" in run("detect", drive, "--model", car).err
    assert "part by part" not in run("detect", drive, "--model", car, "--whole").err


def test_what_parts_cannot_do_is_a_sentence(run: Run, drive: Path, car: Path) -> None:
    for words, said in (
        (("--by-parts",), "needs a --model"),
        (("--by-parts", "--model", car, "--report", "page.html"), "a report needs the whole log"),
        (("--by-parts", "--model", car), "needs a vehicle.toml"),
    ):
        answer = run("detect", drive, *words)
        assert answer.code == 2
        assert said in answer.err
        assert not Path("page.html").exists()
