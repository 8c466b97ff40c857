"""What is learned of ranges: what is counted, on hand-made answers; figures that plotly takes, with the numbers."""

import json

import numpy as np
import plotly.graph_objects as go
import pytest

from sensorfault.evaluation.plain import plain
from sensorfault.training.fuzzy import Fitted, Setting, fit_anfis
from sensorfault.training.labelled import Labelled
from sensorfault_studies.numbers import Numbers
from sensorfault_studies.xu2023 import learning_figures as figures
from sensorfault_studies.xu2023.learners import ANFIS, LOGISTIC, SETTINGS, compared, curves, judged

WRONG_M = 9.0


def ranges(seed: int, rows: int = 60) -> Labelled:
    """A range in five is off by 9 m and more, and its innovation says so to 1 m."""
    rng = np.random.default_rng(seed)
    size = np.abs(np.where(rng.random(rows) < 0.2, rng.uniform(9, 40, rows), rng.normal(0, 2.5, rows)))
    r = np.abs(size + rng.standard_normal(rows))
    return Labelled(np.column_stack([r, r**2 / 11, 9 * np.maximum(1, r**2 / 11)]), size)


@pytest.fixture(scope="module")
def fitted() -> Fitted:
    return fit_anfis(*ranges(0), Setting(epochs=20))


def test_what_is_counted() -> None:
    size, over = np.array([1.0, 2.0, 8.0, 12.0, 20.0]), np.array([0.5, 1.0, -2.0, -0.5, 3.0])
    result = judged(WRONG_M, over, size)
    assert result == pytest.approx({"accuracy": 2 / 5, "recall": 1 / 2, "fpr": 2 / 3, "auc": 4 / 6})
    none = judged(WRONG_M, over, size / 10)
    assert none["accuracy"] == 2 / 5
    assert np.isnan([none["recall"], none["auc"]]).all()


def test_every_way_to_learn_finds_what_is_plain_to_see(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sensorfault_studies.xu2023.learners.SETTINGS", {
        name: Setting(**{**vars(one), "epochs": 2}) for name, one in SETTINGS.items()
    })  # fmt: skip
    numbers = Numbers("E", "simulated", "simulated")
    compared(numbers, "Q0.2", ranges(0), ranges(1, 200), WRONG_M)
    result = {(row.method, row.condition, row.metric): row.value for row in numbers.rows()}
    assert {key[:2] for key in result} == {(LOGISTIC, "Q0.2"), *((ANFIS, f"Q0.2 {name}") for name in SETTINGS)}
    for (_, condition, metric), value in result.items():
        assert value > 0.85 or metric not in ("accuracy", "auc"), (condition, metric)
        assert value < 4.0 or metric != "rms", condition


def test_curves_say_how_many_rows_were_learned_from() -> None:
    numbers = Numbers("E", "simulated", "simulated")
    curves(numbers, "", ranges(0, 100), ranges(1, 200), WRONG_M, (25, 100), draws=2)
    rows = list(numbers.rows())
    assert {row.condition for row in rows} == {"grid n25", "grid n100", "log n25", "log n100", "n25", "n100"}
    assert {row.seeds for row in rows if row.method == ANFIS} == {2}
    figure = figures.learning("e_learning", "Learning curves", rows)
    valid(figure)
    (logistic,) = [line for line in figure.plot["data"] if line["name"] == LOGISTIC]
    assert logistic["x"] == [25, 100]
    want = {row.condition: row.value for row in rows if row.method == LOGISTIC and row.metric == "accuracy"}
    np.testing.assert_allclose(logistic["y"], [want["n25"], want["n100"]], atol=1e-4)


def test_memberships_before_and_after(fitted: Fitted) -> None:
    figure = figures.memberships("e_memberships_1", "ANFIS-1", fitted.start, fitted.model)
    valid(figure)
    lines = [line for line in figure.plot["data"] if line["name"] == ""]
    assert [(line["xaxis"], line["line"]["dash"]) for line in lines] == [
        (axis, dash) for dash in ("dot", "solid") for axis in ("x", "x", "x2", "x2", "x3", "x3")
    ]
    # before training the first bell is 1 / (1 + |x / 0.5|^4)
    np.testing.assert_allclose(lines[0]["y"], 1 / (1 + (np.array(lines[0]["x"]) / 0.5) ** 4), atol=1e-4)
    assert lines[6]["y"] != lines[0]["y"]


@pytest.mark.parametrize("log", [True, False])
def test_the_surface_is_what_the_model_says(log: bool) -> None:
    seen = ranges(0)
    model = fit_anfis(*seen, Setting(epochs=2, log=log)).model
    figure = figures.surface("e_surface_1", "ANFIS-1", model, seen)
    valid(figure)
    drawn, points = figure.plot["data"][2:4]
    low, span = np.asarray(model.unit.low), np.asarray(model.unit.span)
    size = np.log(seen.features) if log else seen.features
    x = np.clip((size - low) / span, 0, 1)
    np.testing.assert_allclose(points["z"], seen.target, atol=1e-4)
    np.testing.assert_allclose(np.array(points["y"]), x[:, 2], atol=1e-4)
    at = low + span * np.array([drawn["x"][20], np.median(x[:, 1]), drawn["y"][9]])
    want = float(model(np.exp(at) if log else at))
    assert drawn["z"][9][20] == pytest.approx(np.clip(want, 0, 1.2 * seen.target.max()), abs=0.02)


def test_features_of_two_filters() -> None:
    one, other = ranges(0), ranges(1)
    figure = figures.features("e_features", "Leader 1", np.arange(60.0), -one.target, one.features, other.features)
    valid(figure)
    error, *lines = figure.plot["data"]
    np.testing.assert_allclose(error["y"], one.target, atol=1e-4)
    assert [(line["name"], line["yaxis"]) for line in lines] == [
        (word, axis) for axis in ("y", "y2", "y3") for word in ("CKF", "ACKF")
    ]
    np.testing.assert_allclose(lines[3]["y"], other.features[:, 1], atol=1e-4)


def valid(figure) -> None:
    """Plotly knows every part of it, and it goes into a page."""
    go.Figure(figure.plot)
    json.dumps(plain(figure.plot), allow_nan=False)
    assert figure.caption.endswith(".")
