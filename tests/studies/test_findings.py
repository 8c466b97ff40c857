"""What a study says: rows that keep their keys, tables that lose no number, a page that hides nothing."""

import json
import math
from collections.abc import Callable
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest

from sensorfault.logs import LogError
from sensorfault_studies.data import real
from sensorfault_studies.findings import SOURCES, Effort, Figure, Findings, Row
from sensorfault_studies.min2021 import study as min2021
from sensorfault_studies.multistep.study import STUDY as MULTISTEP
from sensorfault_studies.study import Reproduction
from sensorfault_studies.tables import PAPER, Cell, ours, printed, tables, thinned

ONE = Row("A1", "dresden", "injected", "L32", "pca", "spike", 1.0, "auc", 0.8412, 0.0123, 5, 0.9)


def sweep() -> tuple[Row, ...]:
    """Two logs, two methods, two metrics, three sizes: 24 numbers, all different."""
    rows = [
        replace(ONE, data=data, method=method, metric=metric, magnitude=size, spread=None, paper=None)
        for data in ("dresden", "0708")
        for method in ("pca", "elm")
        for metric in ("auc", "f1")
        for size in (10.0, 1.0, 3.0)
    ]
    return tuple(replace(row, value=100.0 + i) for i, row in enumerate(rows))


def test_a_row_has_the_keys_that_a_script_checks() -> None:
    assert list(ONE.as_dict()) == [
        "experiment", "data", "source", "condition", "method", "fault", "magnitude", "metric", "value", "spread",
        "seeds", "paper",
    ]  # fmt: skip


def test_findings_add_up_in_order() -> None:
    figure = Figure("a", "A", "", {})
    whole = Findings((ONE,), (figure,), ("first",)) + Findings((replace(ONE, value=2.0),), (), ("second",))
    assert [row.value for row in whole.rows] == [0.8412, 2.0]
    assert whole.figures == (figure,)
    assert whole.remarks == ("first", "second")


@pytest.mark.parametrize(
    ("value", "spread", "want"),
    [
        (0.8412, 0.0123, Cell("0.84", "±0.01")),
        (0.9951, 0.001, Cell("0.995", "±0.001")),
        (1.0, 0.0, Cell("1.00", "±0.00")),
        (0.00163, 0.0002, Cell("0.0016", "±0.0002")),
        (883.4, None, Cell("883")),
        (0.0, None, Cell("0.00")),
        (0.0623, None, Cell("0.06")),
        (-23.456, 1.0, Cell("-23.5", "±1.0")),
        (math.nan, math.nan, Cell("–")),
        (math.inf, None, Cell("–")),
        (0.5, math.nan, Cell("0.50")),
    ],
)
def test_a_number_has_the_digits_it_deserves(value: float, spread: float | None, want: Cell) -> None:
    assert ours(replace(ONE, value=value, spread=spread)) == want


@pytest.mark.parametrize(
    ("paper", "want"), [(None, ""), (0.9, "0.90"), (12.34, "12.34"), (0.0, "0.00"), (math.nan, "–")]
)
def test_the_papers_number(paper: float | None, want: str) -> None:
    assert printed(replace(ONE, paper=paper)) == Cell(want)


def test_the_papers_number_stands_beside_ours() -> None:
    rows = [replace(row, paper=0.5 if row.magnitude == 3.0 and row.method == "elm" else None) for row in sweep()]
    (table,) = tables(rows)
    assert table.heads == ("1", "3", PAPER, "10")
    assert [cells[2].value for _, cells in table.rows] == ["", "0.50"] * 4
    assert [cells[3].value for _, cells in table.rows[:2]] == ["100", "106"]


def test_magnitudes_stand_across_and_methods_below_each_other() -> None:
    (table,) = tables(sweep())
    assert table.title == "spike by magnitude [σ]"
    assert table.source == "real logs with injected faults"
    assert (table.labels, table.heads) == (("data", "metric", "method", "condition"), ("1", "3", "10"))
    assert [labels[:3] for labels, _ in table.rows[:4]] == [
        ("dresden", "auc", "pca"), ("dresden", "auc", "elm"), ("dresden", "f1", "pca"), ("dresden", "f1", "elm"),
    ]  # fmt: skip
    result = {
        (*labels[:3], float(head)): float(number.value)
        for labels, cells in table.rows
        for head, number in zip(table.heads, cells, strict=True)
    }
    assert result == {(row.data, row.metric, row.method, row.magnitude): row.value for row in sweep()}


def test_what_was_measured_once_has_metrics_across() -> None:
    fit = replace(ONE, source="real", fault=None, magnitude=None, metric="fit_s", value=123.0)
    rate = replace(fit, metric="far", value=456.0, method="elm", paper=None)
    both = replace(rate, metric="fit_s", value=789.0)
    sweeps, single = tables((*sweep(), fit, rate, both))
    assert sweeps.heads == ("1", "3", "10")
    assert (single.title, single.source, single.heads) == ("", "real logs", ("fit_s", PAPER, "far"))
    numbers = [[number.value for number in cells] for _, cells in single.rows]
    assert numbers == [["123", "0.90", ""], ["789", "", "456"]]


def test_what_has_no_metric_in_common_stands_apart() -> None:
    fit = replace(ONE, source="real", fault=None, magnitude=None, spread=None, paper=None, condition="", value=100.0)
    rows = [
        replace(fit, metric="fit_s"),
        replace(fit, metric="auc", method="elm", value=101.0),
        replace(fit, metric="far", method="bp", value=102.0),
        replace(fit, metric="auc", method="bp", value=103.0),
    ]
    fits, scores = tables(rows)
    assert (fits.heads, [labels for labels, _ in fits.rows]) == (("fit_s",), [("dresden", "pca")])
    assert scores.heads == ("auc", "far")
    assert [[number.value for number in cells] for _, cells in scores.rows] == [["101", ""], ["103", "102"]]


def test_many_magnitudes_go_down() -> None:
    rows = [replace(ONE, fault="offset", magnitude=size / 7, value=100.0 + size) for size in range(1, 14)]
    rows = [replace(row, paper=None) for row in rows]
    (table,) = tables(rows)
    assert table.labels == ("data", "magnitude", "method", "condition")
    assert table.heads == ("auc",)
    assert [cells[0].value for _, cells in table.rows] == [str(100 + size) for size in range(1, 14)]


def test_no_number_is_lost_whatever_the_rows_are() -> None:
    kinds = ("spike", "frozen", "offset", None)
    rows = [
        replace(ONE, fault=fault, magnitude=size, source=source, condition=condition, value=100.0 + i, spread=None)
        for i, (fault, size, source, condition) in enumerate(
            (fault, size, source, condition)
            for fault in kinds
            for size in ((None, 1.0, 2.0) if fault else (None,))
            for source in SOURCES
            for condition in ("", "far1e-2")
        )
    ]
    result = sorted(
        int(c.value)
        for table in tables(rows)
        for _, cells in table.rows
        for head, c in zip(table.heads, cells, strict=True)
        if c.value and head != PAPER
    )
    assert result == [int(row.value) for row in rows]


def test_labels_are_not_repeated() -> None:
    labels = [("a", "x", "m"), ("a", "x", "n"), ("a", "y", "n"), ("b", "y", "n"), ("b", "y", "n")]
    assert thinned(labels) == [("a", "x", "m"), ("", "", "n"), ("", "y", "n"), ("b", "y", "n"), ("", "", "n")]
    assert thinned([]) == []


class Seen(HTMLParser):
    """Text and tags, as a browser would see them."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.words: list[str] = []
        self.scripts: list[str] = []
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.open = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.open = tag
        self.tags.append((tag, dict(attrs)))
        if tag == "script":
            self.scripts.append("")

    def handle_endtag(self, tag: str) -> None:
        self.open = ""

    def handle_data(self, data: str) -> None:
        if self.open == "script":
            self.scripts[-1] += data
        elif self.open != "style":
            self.words.append(data)


def shown(findings: Findings) -> Seen:
    return Seen(Reproduction(min2021.STUDY, findings).page("commit 123 & more"))


def test_the_page_has_tables_figures_and_remarks() -> None:
    plot = {"data": [{"y": [1.0, math.nan]}], "layout": {"title": {"text": "no"}}}
    figures = (Figure("a1-roc", "ROC", "Upper left is better.", plot), Figure("other", "Else", "See.", plot))
    seen = shown(Findings((replace(ONE, data="else"), *sweep()), figures, ("A remark.",)))
    text = " ".join(seen.words)
    for words in ("Min et al. 2021", "A1 Shorts", "commit 123 & more", "0.84", "±0.01", "0.90", "ROC", "A remark."):
        assert words in text
    assert text.index("Upper left") < text.index("Else")
    assert all(f"{row.value:.0f}" in text for row in sweep())
    places = [attrs["id"] for tag, attrs in seen.tags if attrs.get("class") == "plot"]
    assert places == list(json.loads(seen.scripts[0])) == ["figure-a1-roc", "figure-other"]
    assert json.loads(seen.scripts[0])["figure-other"]["data"][0]["y"] == [1.0, None]
    assert "plotly.js v" in seen.scripts[1][:100]


def test_a_figure_stands_with_the_experiment_whose_whole_name_it_bears() -> None:
    rows = tuple(replace(ONE, experiment=code) for code in ("D", "D-slow"))
    figures = tuple(Figure(name, f"Figure {name}", "", {"data": [], "layout": {}}) for name in ("d-slow_b", "d_a"))
    text = Reproduction(MULTISTEP, Findings(rows, figures)).page("")
    places = [text.index(part) for part in ("Figure d_a", "<h2>D-slow", "Figure d-slow_b")]
    assert places == sorted(places)


def test_the_page_asks_nobody_for_anything() -> None:
    text = Reproduction(min2021.STUDY, Findings((ONE,))).page("")
    assert "default-src 'none'" in text
    outside = [attrs for _, attrs in Seen(text).tags if {"src", "href"} & attrs.keys()]
    assert not outside
    assert "Remarks" not in " ".join(Seen(text).words)


def test_words_of_a_study_stay_words() -> None:
    evil = "</script><script>alert(1)</script>"
    row = replace(ONE, experiment=evil, data=evil, condition=evil, method=evil, fault=evil, metric=evil)
    figure = Figure("f", evil, evil, {"data": [{"name": evil}], "layout": {}})
    seen = shown(Findings((row,), (figure,), (evil,)))
    assert len(seen.scripts) == 3
    assert " ".join(seen.words).count(evil) >= 8


def test_real_logs_that_are_not_there_are_one_sentence(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SENSORFAULT_DATA", str(tmp_path))
    with pytest.raises(LogError, match="needs these real logs; set SENSORFAULT_DATA"):
        real("road/nowhere")
    (tmp_path / "road" / "here").mkdir(parents=True)
    assert real("road/here") == tmp_path / "road" / "here"


def test_a_study_says_so_before_it_works(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "road" / "dresden_50hz").mkdir(parents=True)
    monkeypatch.setenv("SENSORFAULT_DATA", str(tmp_path))
    monkeypatch.setattr(min2021, "EXPERIMENTS", {"A1": lambda effort: pytest.fail("it went to work")})
    with pytest.raises(LogError, match="gnss_imu_drive0708"):
        min2021.STUDY.run(Effort())


def test_the_experiments_add_up_in_order(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for folder in min2021.DATA:
        (tmp_path / folder).mkdir(parents=True)
    monkeypatch.setenv("SENSORFAULT_DATA", str(tmp_path))
    result: list[tuple[str, float]] = []

    def experiment(code: str) -> Callable[[Effort], Findings]:
        def run(effort: Effort) -> Findings:
            effort.tell("going", 0.5)
            return Findings((replace(ONE, experiment=code, seeds=effort.seeds),), (Figure("f", "", "", {}),), (code,))

        return run

    assert list(min2021.EXPERIMENTS) == list(min2021.STUDY.experiments) == ["A1", "A2", "A3", "A4"]
    monkeypatch.setattr(min2021, "EXPERIMENTS", {code: experiment(code) for code in ("A1", "A2")})
    findings = min2021.STUDY.run(Effort(7, tell=lambda doing, share: result.append((doing, share))))
    assert [(row.experiment, row.seeds) for row in findings.rows] == [("A1", 7), ("A2", 7)]
    assert [figure.name for figure in findings.figures] == ["a1-f", "a2-f"]
    assert findings.remarks == ("A1", "A2")
    assert result == [("A1 going", 0.25), ("A2 going", 0.75)]


def test_an_experiments_progress_is_a_part_of_the_studys() -> None:
    result: list[tuple[str, float]] = []
    tell = min2021._part(lambda doing, share: result.append((doing, share)), "A3", 2, 4)
    tell("fitting", 0.0)
    tell("fitting", 0.5)
    tell("A3 judging", 7.0)
    assert result == [("A3 fitting", 0.5), ("A3 fitting", 0.625), ("A3 judging", 0.75)]


def test_figures_are_filed_under_their_experiment() -> None:
    figures = tuple(Figure(name, name, "", {}) for name in ("roc", "a2-curve"))
    filed = min2021._filed("A2", Findings((), figures, ("Seen.", "A2: seen.")))
    assert [figure.name for figure in filed.figures] == ["a2-roc", "a2-curve"]
    assert filed.remarks == ("A2: Seen.", "A2: seen.")
