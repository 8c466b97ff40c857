"""`sensorfault reproduce` on a study of three numbers."""

import json
import math
import re
from pathlib import Path

import pytest

from cli.conftest import Install, Run
from sensorfault.logs import LogError
from sensorfault_studies.findings import Effort, Figure, Findings, Row
from sensorfault_studies.study import Study

SHORT = Row("X1", "a drive", "injected", "", "good", "spike", 2.0, "auc", 0.912, 0.021, 3, 0.99)


@pytest.fixture
def asked(install: Install) -> list[Effort]:
    """A tiny study is the only one installed; the efforts it was asked for."""
    efforts: list[Effort] = []

    def study(effort: Effort) -> Findings:
        efforts.append(effort)
        effort.tell("halfway there", 0.5)
        fit = Row("X2", "a drive", "real", "", "good", None, None, "fit_s", math.nan)
        rate = Row("X2", "made up", "simulated", "", "good", None, None, "far", 0.125)
        figure = Figure("x1-roc", "A curve", "Look at it.", {"data": [{"x": [0, 1], "y": [0, 1]}], "layout": {}})
        return Findings((SHORT, fit, rate), (figure,), ("The margin [of the paper] does not appear.",))

    tiny = Study("tiny2000", "Nothing much", "Nobody 2000", study, {"X1": "Spikes", "X2": "The rest"})
    install(tiny)
    return efforts


def test_tables_and_remarks(run: Run, asked: list[Effort]) -> None:
    said = run("reproduce", "tiny2000", "--seeds", "3")
    assert said.code == 0
    assert [(effort.seeds, effort.quick) for effort in asked] == [(3, False)]
    assert "X1 Spikes · spike of 2 σ · real logs with injected faults" in said.out
    assert re.search(r"auc +paper\n.*\n.* 0.91 ±0.02 +0.99\n", said.out)
    assert "X2 The rest · real logs" in said.out
    assert "X2 The rest · simulated" in said.out
    assert "The margin [of the paper] does not appear." in said.err
    assert "±" not in said.err


def test_quick_and_the_usual_seeds(run: Run, asked: list[Effort]) -> None:
    assert run("reproduce", "tiny2000", "--quick").code == 0
    assert [(effort.seeds, effort.quick) for effort in asked] == [(5, True)]


def test_json_has_the_rows_and_nan_is_null(run: Run, asked: list[Effort]) -> None:
    said = run("reproduce", "tiny2000", "--json", "-")
    answer = json.loads(said.out)
    assert list(answer) == ["study", "commit", "rows"]
    assert answer["study"] == "tiny2000"
    assert answer["commit"]
    assert answer["rows"][0] == SHORT.as_dict()
    assert answer["rows"][1]["value"] is None
    assert len(answer["rows"]) == 3
    assert "0.91 ±0.02" in said.err  # the tables give way to JSON


def test_a_folder_gets_the_page_and_the_rows(run: Run, asked: list[Effort]) -> None:
    said = run("reproduce", "all", "--out", "new/folder", "--json", "rows.json")
    assert said.code == 0
    page = Path("new/folder/tiny2000.html").read_text()
    for words in ("Nobody 2000: Nothing much", "X1 Spikes", "A curve", "Look at it.", "5 seeds"):
        assert words in page
    rows = json.loads(Path("new/folder/tiny2000.json").read_text())
    assert rows["study"] == "tiny2000"
    assert json.loads(Path("rows.json").read_text())["rows"] == rows["rows"]
    assert sorted(path.name for path in Path("new/folder").iterdir()) == ["tiny2000.html", "tiny2000.json"]


def refused(run: Run, asked: list[Effort], *words: object) -> str:
    said = run("reproduce", *words)
    assert (said.code, said.out) == (2, "")
    assert not asked
    (line,) = said.err.strip().splitlines()
    assert line.startswith("sensorfault: ")
    return line


def test_bad_words_are_one_sentence_before_any_work(run: Run, asked: list[Effort]) -> None:
    assert "take one of tiny2000, or all" in refused(run, asked, "min2099")
    assert "--seeds" in refused(run, asked, "tiny2000", "--seeds", "0")
    Path("taken").write_text("mine")
    assert "taken is a file" in refused(run, asked, "tiny2000", "--out", "taken")
    assert "taken is a file" in refused(run, asked, "tiny2000", "--out", "taken/below")
    assert "there is no folder" in refused(run, asked, "tiny2000", "--json", "nowhere/rows.json")
    Path("full/tiny2000.html").mkdir(parents=True)
    assert "is a folder" in refused(run, asked, "tiny2000", "--out", "full")
    assert Path("taken").read_text() == "mine"


def test_nothing_is_written_where_the_work_fails(run: Run, install: Install) -> None:
    def study(effort: Effort) -> Findings:
        raise LogError("road/dresden_50hz: this study needs these real logs; set SENSORFAULT_DATA to where they lie.")

    install(Study("tiny2000", "", "", study, {}))
    said = run("reproduce", "tiny2000", "--out", "results", "--json", "rows.json")
    assert said.code == 2
    assert said.err.strip().splitlines()[-1].startswith("sensorfault: road/dresden_50hz: this study needs")
    assert not Path("results").exists()
    assert not Path("rows.json").exists()
