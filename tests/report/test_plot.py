"""The figure of a detection, with the parts of the report page."""

import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest

import fitted
import sensorfault as sf
from sensorfault.core import extras
from sensorfault.logs.table import LogError
from sensorfault.report.plot_dress import palette


def test_a_detection_draws_itself() -> None:
    found = fitted.found()
    figure = found.plot()
    import plotly.graph_objects as go

    assert isinstance(figure, go.Figure)
    assert figure == sf.plot(found)
    names = [note.text for note in figure.layout.annotations]
    for sensor in ("gyro", "accelerometer", "gnss"):
        assert f"<b>{sensor}</b>" in names
    assert "gyro <b>x</b> [deg/s]" in names
    assert "<b>norm</b> all channels together" in names


def test_signals_stand_ins_scores_and_limits_are_drawn_as_they_are() -> None:
    found = fitted.found()
    figure = found.plot(sensors=["gyro"])
    by_name = {}
    for trace in figure.data:
        by_name.setdefault(trace.name, []).append(trace)
    (x,) = by_name["x"]
    mine = np.searchsorted(found.log.time, x.x[:50] - 1e-3)
    np.testing.assert_allclose(x.y[:50], np.rad2deg(found.log.value[mine, 0]), rtol=1e-4, atol=1e-4)
    assert {"x, stand-in", "z, stand-in", "score", "limit"} <= set(by_name)
    assert len(by_name["score"]) == len(found.traces)
    assert np.nanmax(by_name["score"][0].y) == pytest.approx(np.nanmax(found.traces[0].score), rel=1e-5)
    assert by_name["limit"][0].line.color == palette(False)["fault"]


def test_faulty_stretches_are_shaded_on_their_own_rows() -> None:
    found = fitted.found()
    figure = found.plot(sensors=["gyro"], scores=False)
    spans = {(shape.x0, shape.x1): shape.yref for shape in figure.layout.shapes if shape.type == "rect"}
    offset = next(event for event in found.events if event.where == "gyro.z" and event.kind == "offset")
    assert spans[(offset.start_s, offset.end_s)] == "y3 domain"
    assert figure.layout.yaxis3.domain[1] <= figure.layout.yaxis2.domain[0]
    drift = next(event for event in found.events if event.where == "accelerometer.y")
    assert (drift.start_s, drift.end_s) not in spans


def test_verdicts_are_bands_above_on_the_same_time_axis() -> None:
    found = fitted.found()
    figure = found.plot()
    bars = [trace for trace in figure.data if trace.type == "bar"]
    faulty = next(bar for bar in bars if bar.marker.color == palette(False)["fault"])
    drawn = sum(x for x, lane in zip(faulty.x, faulty.y, strict=True) if round(lane) == 0)
    assert drawn == pytest.approx(0.02 * np.sum(found.sensor[:, 0] == 2), abs=0.5)
    assert {bar.xaxis for bar in bars} == {"x"}
    assert figure.layout.yaxis99.domain[0] >= figure.layout.yaxis.domain[1]
    assert tuple(figure.layout.xaxis.range) == (100.0, pytest.approx(199.98))


def test_the_truth_is_drawn_beside() -> None:
    found = fitted.found()
    texts = [text for trace in found.plot(truth=fitted.lying().truth).data for text in trace.hovertext or ()]
    assert any("injected offset in gyro z, found" in text for text in texts)


def test_dark_is_the_other_palette_and_no_background_is_fixed() -> None:
    assert palette(True).keys() == palette(False).keys()
    assert palette(True)["signal"] == "#74b3e8"
    for dark in (False, True):
        figure = fitted.found().plot(dark=dark)
        assert figure.layout.paper_bgcolor == figure.layout.plot_bgcolor == "rgba(0,0,0,0)"
        assert figure.layout.annotations[0].font.color == palette(dark)["text"]
        assert '"--' not in figure.to_json()


def test_verdicts_alone_are_a_figure() -> None:
    figure = fitted.found().plot(sensors=[], scores=False)
    assert figure.layout.xaxis.anchor == "y99"
    assert {trace.type for trace in figure.data} == {"bar"}


def test_long_lines_are_thinned_but_keep_their_extremes() -> None:
    from fitted import detect, rig

    log = rig(1000.0, 3)
    value = log.value.copy()
    value[31234, 0] = 5.0
    found = detect(fitted.model(), replace(log, value=value))
    figure = found.plot(sensors=["gyro"], scores=False)
    (x,) = (trace for trace in figure.data if trace.name == "x")
    assert len(x.x) < len(log) / 2
    assert np.nanmax(x.y) == pytest.approx(np.rad2deg(5.0), rel=1e-5)


def test_no_such_sensor_is_one_sentence() -> None:
    with pytest.raises(LogError, match="no sensor is called 'radar'; take one of gyro, accelerometer, gnss"):
        fitted.found().plot(sensors=["radar"])


def test_without_plotly_one_sentence_says_what_to_do(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "plotly", None)
    monkeypatch.setattr(extras, "find_spec", lambda name: None)
    with pytest.raises(extras.MissingLibrary, match=r"a plot needs plotly; run `pip install 'sensorfault\[plot\]'`"):
        fitted.found().plot()


def test_who_draws_is_known_wherever_a_detection_comes_from() -> None:
    """Without the public face asked for anything, and without plotly before it is needed."""
    code = (
        "import sys\n"
        "from sensorfault.core.plotting import _drawers\n"
        "from sensorfault.runtime.result import Detection\n"
        "assert len(_drawers) == 1\n"
        "assert 'plotly' not in sys.modules and 'sensorfault.report.plot' not in sys.modules\n"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
