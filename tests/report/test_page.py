"""The report page: what is drawn of a long signal, what the page says, and that names from files stay names."""

import base64
import json
import os
import subprocess
import sys
from dataclasses import replace
from html.parser import HTMLParser
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from sensorfault.core.verdicts import FAULT, UNKNOWN
from sensorfault.events.event import Event
from sensorfault.faults.fault import Fault
from sensorfault.logs.table import Channel, Log, Sensor
from sensorfault.report import page
from sensorfault.report.page import write_page
from sensorfault.report.page_lines import extremes, line, near, runs
from sensorfault.report.page_sketch import Sketch, replaced, stale
from sensorfault.report.page_words import found, headline
from sensorfault.runtime.result import Detection, RowsNotKept, Trace

RATE = 50


class Page(HTMLParser):
    """What a browser would see: tags, text outside scripts, scripts, and the table rows that zoom."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[tuple[str, dict[str, str | None]]] = []
        self.scripts: list[str] = []
        self.words: list[str] = []
        self.rows: list[list[str]] = []
        self._open = ""
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append((tag, dict(attrs)))
        self._open = tag
        if tag == "script":
            self.scripts.append("")
        if tag == "tr" and dict(attrs).get("data-from"):
            self.rows.append([])
        if tag == "td":
            self.rows[-1].append("")

    def handle_endtag(self, tag):
        self._open = ""

    def handle_data(self, data):
        if self._open == "script":
            self.scripts[-1] += data
        elif self._open == "td":
            self.rows[-1][-1] += data
        elif self._open != "style":
            self.words.append(data)

    @property
    def text(self) -> str:
        return " ".join(self.words)

    @property
    def figures(self) -> dict:
        return json.loads(self.scripts[0])


def unpacked(array: dict) -> np.ndarray:
    return np.frombuffer(base64.b64decode(array["f4"]), "<f4").astype(float) + array["from"]


def drive(seconds: float = 60, name: str = "drive", gyro: str = "gyro") -> Detection:
    """A gyro of two channels with a one-sample fault at 10 s and a bias from 30 to 40 s, and a held gnss."""
    rows = int(seconds * RATE)
    rng = np.random.default_rng(1)
    time = np.arange(rows) / RATE
    value = np.column_stack((rng.normal(size=(rows, 2)) * 0.01, np.repeat(np.arange(rows // 5), 5) * 1e-6 + 0.9))
    fresh = np.ones((rows, 3), dtype=bool)
    fresh[:, 2] = np.arange(rows) % 5 == 0
    repaired = value.copy()
    channel = np.zeros((rows, 3), dtype=np.int8)
    channel[500, 1] = channel[1500:2000, 0] = FAULT
    channel[:100, :2] = UNKNOWN
    value[500, 1] += np.pi  # 180 deg/s
    value[1500:2000, 0] += 1
    log = Log(
        time,
        value,
        fresh,
        (Channel("x", gyro, "deg/s"), Channel("z", gyro, "deg/s"), Channel("latitude", "gnss", "deg", watch=False)),
        (Sensor(gyro, 0.02), Sensor("gnss", 0.1, held=True)),
        name,
        ("gnss repeats 80 % of its rows.",),
    )
    sensor = np.column_stack((channel[:, :2].max(axis=1), channel[:, 2]))
    events = (
        Event(10.0, 10.0, "sensor", gyro, "z", "spike", 9.5, 3.0, "elm"),
        Event(30.0, None, "sensor", gyro, "x", "offset", 7.25, 3.0, "elm"),
    )
    score = rng.chisquare(3, rows)
    score[500] = 1e4
    traces = (
        Trace("norm", None, score, np.full(rows, 3.0)),
        Trace("repeats", "x", np.zeros(rows), np.full(rows, np.inf)),
    )
    traces[1].score[500] = 50
    return Detection(
        log, "elm", (True, True, False), channel, sensor, sensor.max(axis=1), still(rows), repaired, traces, events
    )


def figures(detection: Detection, truth: tuple[Fault, ...] = ()) -> dict:
    return page.figures(Sketch.of(detection), truth)


def still(rows: int) -> np.ndarray:
    """The verdict of a method that does not judge how the vehicle moves."""
    return np.full(rows, UNKNOWN, np.int8)


TRUTH = (
    Fault("spike", "gyro", "z", 10.0, 0.02, 180.0),
    Fault("drift", "gnss", None, 50.0, 5.0, 1.0),
    Fault("offset", "gyro", "x", 30.0, 10.0, 2.0, sigmas=True),
)


def written(tmp_path: Path, detection: Detection, truth: tuple[Fault, ...] = (), summary: tuple[str, ...] = ()) -> Page:
    path = tmp_path / "page.html"
    write_page(detection, path, truth, summary=summary)
    return Page(path.read_text("utf-8"))


# What is drawn of a signal


@pytest.mark.parametrize("place", [0, 1, 777, 4999, 9998, 9999])
@pytest.mark.parametrize("height", [5.0, -5.0])
def test_spike_of_one_sample_survives(place, height):
    value = np.random.default_rng(0).uniform(size=10_000)
    value[place] = height
    drawn = extremes(value, 50)
    assert place in drawn
    assert drawn.size <= 102
    assert (np.diff(drawn) > 0).all()
    assert {0, 9999} <= set(drawn.tolist())


def test_short_signal_is_drawn_whole():
    assert extremes(np.zeros(20), 10).tolist() == list(range(20))
    assert extremes(np.zeros(0), 10).size == 0


def test_gap_stays_a_gap():
    time = np.arange(3000) / RATE
    value = np.sin(time)
    value[1000:1100] = np.nan
    value[2000] = np.inf  # not a number to be drawn, and too short to be a gap
    x, y = line(time, value, np.zeros(3000, dtype=bool), 100)
    assert np.isnan(y).sum() == 1
    assert time[999] < x[np.isnan(y)][0] < time[1100]
    assert {time[999], time[1100]} <= set(x.tolist())
    assert (np.diff(x) > 0).all()


def test_slow_sensor_on_a_fast_clock_is_one_line():
    time = np.arange(1000) / RATE
    value = np.where(np.arange(1000) % 5 == 0, 1.0, np.nan)
    x, y = line(time, value, np.zeros(1000, dtype=bool), 1000)
    assert np.isfinite(y).all()
    assert x.size == 200


def test_of_very_many_gaps_the_longest_stay():
    rows = 30_000
    value = np.ones(rows)
    value[np.arange(rows) % 10 > 5] = np.nan
    value[15_000:15_100] = np.nan
    x, y = line(np.arange(rows) / RATE, value, np.zeros(rows, dtype=bool), 400)
    assert x.size < 1000
    assert ((x[np.isnan(y)] > 300) & (x[np.isnan(y)] < 302)).any()


def test_every_sample_around_an_event_is_drawn():
    time = np.arange(100_000) / RATE
    keep = near(time, [(1000.0, 1010.0)], 4000)
    x, _ = line(time, np.sin(time), keep, 200)
    around = time[(time >= 995) & (time < 1015)]
    assert np.isin(around, x).all()
    assert x.size < around.size + 300


def test_of_a_long_event_both_ends_are_drawn_and_the_budget_is_kept():
    time = np.arange(100_000) / RATE
    keep = near(time, [(100.0, 1900.0), (50.0, 50.0)], 1000)
    assert keep[[4995, 5000, 5005, 94_995, 95_000, 95_005, 2450, 2500, 2550]].all()
    assert not keep[50_000]
    assert keep.sum() < 1100


def test_single_fault_survives_when_verdicts_flicker():
    verdict = np.tile(np.array([0, 1], dtype=np.int8), 5000)
    verdict[4321] = FAULT
    start, value = runs(verdict, most=200)
    assert start.size <= 200
    assert (value == FAULT).sum() == 1
    assert abs(start[value == FAULT][0] - 4321) <= 50


def test_runs_are_exact_where_they_are_few():
    start, value = runs(np.array([1, 1, 0, 0, 2, 0], dtype=np.int8))
    assert start.tolist() == [0, 2, 4, 5]
    assert value.tolist() == [1, 0, 2, 0]
    assert runs(np.zeros(0, dtype=np.int8))[0].size == 0


def test_a_held_fix_is_stale_only_beyond_its_own_period():
    log = drive().log
    assert not stale(log, 2).any()
    log.fresh[1000:1500, 2] = False
    assert not stale(log, 2)[995:1008].any()  # 995 is the last fix, the next one is due at 1000
    assert stale(log, 2)[1010:1500].all()
    assert not stale(log, 2)[1500:].any()


def test_stand_in_is_tied_to_the_samples_beside_it():
    detection = drive()
    shown = np.flatnonzero(np.isfinite(replaced(detection, 1)))
    assert shown.tolist() == [499, 500, 501]
    assert replaced(detection, 1)[500] == detection.repaired[500, 1]


def test_gathered_part_by_part_it_is_the_same():
    detection = drive()
    detection.log.value[1210:1510, 1] = np.nan  # a gap over an edge of parts
    detection.log.fresh[995:1015, 2] = False  # held for too long, over another
    whole, parts = Sketch.of(detection), None
    for start in range(0, 3000, 500):
        rows = slice(start, start + 500)
        part = replace(
            detection,
            log=detection.log._rows(rows),
            channel=detection.channel[rows],
            sensor=detection.sensor[rows],
            sample=detection.sample[rows],
            motion=detection.motion[rows],
            repaired=detection.repaired[rows],
            traces=tuple(replace(t, score=t.score[rows], limit=t.limit[rows]) for t in detection.traces),
            events=tuple(event for event in detection.events if event.start_s < (start + 500) / RATE),
        )
        parts = parts or Sketch()
        parts.take(part, 1 / 6)
    assert (parts.rows, parts.span, parts.events) == (whole.rows, whole.span, whole.events)
    assert [(name, lane.start, lane.verdict) for name, lane in parts.lanes] == [
        (name, lane.start, lane.verdict) for name, lane in whole.lanes
    ]
    for mine, theirs in zip(parts.channels, whole.channels, strict=True):
        tied = np.isin(theirs.stand_in.x, mine.stand_in.x, invert=True)
        assert tied.sum() <= 2  # but for the sample before or after, where that is in another part
        for name in ("measured", "held"):
            np.testing.assert_array_equal(getattr(mine, name).x, getattr(theirs, name).x)
            np.testing.assert_array_equal(getattr(mine, name).y, getattr(theirs, name).y)
    assert [test.spans_much for test in parts.tests.values()] == [test.spans_much for test in whole.tests.values()]


def test_a_page_of_a_log_in_parts_needs_its_sketch(tmp_path):
    detection = drive()
    ends = detection.log._rows([0, -1])
    bare = detection.without_rows(replace(ends, notes=("Read in parts.",)), 3000)
    with pytest.raises(RowsNotKept, match="was judged in parts"):
        write_page(bare, tmp_path / "page.html")
    assert not (tmp_path / "page.html").exists()
    write_page(bare, tmp_path / "page.html", sketch=Sketch.of(detection))
    seen = Page((tmp_path / "page.html").read_text("utf-8"))
    assert "3,000 samples" in seen.text
    assert "Read in parts." in seen.text
    assert seen.figures == figures(detection)


def test_a_sketch_of_fewer_points():
    few, many = (Sketch.of(replace(drive(6000), events=()), points) for points in (1000, 100_000))
    assert 5 * few.channels[0].measured.x.size < many.channels[0].measured.x.size


def test_a_short_part_has_few_points():
    detection = drive(6000)
    sketch = Sketch()
    sketch.take(replace(detection, events=()), 0.001)
    assert sketch.channels[0].measured.x.size < 100


# What the page says


def test_page_is_one_file_that_asks_nobody(tmp_path):
    seen = written(tmp_path, drive(), TRUTH)
    assert not [tag for tag, attrs in seen.tags if {"src", "href", "action", "data"} & attrs.keys()]
    assert not [tag for tag, _ in seen.tags if tag in ("link", "img", "iframe", "object", "embed", "base")]
    policy = [attrs["content"] for tag, attrs in seen.tags if attrs.get("http-equiv") == "Content-Security-Policy"]
    assert policy[0].startswith("default-src 'none';")
    assert [("plotly.js v" in script[:100]) for script in seen.scripts] == [False, True, False]
    assert os.listdir(tmp_path) == ["page.html"]


def test_headline_and_notes(tmp_path):
    seen = written(tmp_path, drive(), summary=("Fitted on the first 20 s.",))
    text = seen.text
    assert "2 faults on 1 sensor; 1 sensor watched, gnss checked for dropouts only." in text
    assert "duration 0:59.98 · 3,000 samples at 50 Hz · 2 sensors · 3 channels · method elm" in text
    assert "gnss repeats 80 % of its rows." in text
    assert "Fitted on the first 20 s." in text
    assert "Injected faults" not in text


def test_a_channel_that_is_not_judged_says_so(tmp_path):
    half = replace(drive(), watched=(True, False, False))
    seen = written(tmp_path, half)
    assert "2 faults on 1 sensor; 1 sensor watched, gnss checked for dropouts only." in seen.text
    assert " ".join(seen.words).count(" checked for dropouts only") == 2  # beside gnss
    labels = [a["text"] for a in seen.figures["signals-0"]["layout"]["annotations"] if "<b>" in a["text"]]
    assert labels == ["<b>x</b> [deg/s]", "<b>z</b> [deg/s], checked for dropouts only"]
    none = written(tmp_path, replace(drive(), watched=(False,) * 3)).text
    assert "no sensors watched, gyro, gnss checked for dropouts only." in none


def test_events_without_a_sensor_are_told_apart(tmp_path):
    nameless = Event(1.0, 2.0, "sensor", None, None, "unknown", 5.0, 1.0, "elm")
    events = (nameless, replace(nameless, subject="motion"), replace(nameless, kind="missing"))
    detection = replace(drive(), events=events)
    said = "1 fault, 1 of them on an unknown sensor, 1 implausible motion, 1 gap in the log; 1 sensor watched"
    assert headline(Sketch.of(detection)).startswith(said)
    rows = written(tmp_path, detection).rows
    assert [row[3] for row in rows] == ["unknown which", "vehicle motion", "the whole log"]
    assert [row[6] for row in rows] == ["5 / 1", "5 / 1", "5 / 1 s silent"]


def test_event_rows_zoom_to_their_time(tmp_path):
    seen = written(tmp_path, drive())
    assert seen.rows == [
        ["1", "10.00 s ", "10.00 s ", "gyro", "z", "spike", "9.5 / 3", "elm"],
        ["2", "30.00 s ", "ongoing", "gyro", "x", "offset", "7.25 / 3", "elm"],
    ]
    times = [(float(attrs["data-from"]), float(attrs["data-to"])) for tag, attrs in seen.tags if "data-from" in attrs]
    assert times == [(10.0, 10.0), (30.0, pytest.approx(59.98))]


def test_injected_fault_that_was_not_found_is_shown_as_missed(tmp_path):
    seen = written(tmp_path, drive(), TRUTH)
    assert [row[-1] for row in seen.rows[2:]] == ["found", "found", "missed"]  # in the order of time
    assert "2 of 3 found" in seen.text
    result = [text for trace in seen.figures["verdicts"]["data"] for text in trace["hovertext"] if "missed" in text]
    assert result == ["injected drift in gnss , missed"] * 2  # the hollow line, and the cross on it
    lines = [s["line"]["dash"] for s in seen.figures["signals-1"]["layout"]["shapes"] if s["type"] == "line"]
    assert lines == ["dot"]


def test_found_needs_the_same_sensor_and_overlap():
    fault = Fault("offset", "gyro", "x", 30.0, 10.0)
    event = Event(39.0, 45.0, "sensor", "gyro", "y", "drift", None, None, "elm")
    assert found(fault, [event])
    assert found(fault, [replace(event, start_s=0.0, end_s=None)])
    assert not found(fault, [replace(event, start_s=40.5)])
    assert not found(fault, [replace(event, start_s=0.0, end_s=29.9)])
    assert not found(fault, [replace(event, sensor="gnss")])
    assert not found(fault, [])


def test_found_under_another_name_says_so(tmp_path):
    truth = (Fault("drift", "gyro", None, 30.0, 10.0), Fault("spike", "gyro", "z", 10.0, 0.02))
    near_miss = Event(9.0, 11.0, "sensor", "gyro", "x", "spike", 9.5, 3.0, "elm")
    detection = replace(drive(), events=(near_miss, *drive().events))
    assert [row[-1] for row in written(tmp_path, detection, truth).rows[3:]] == ["found", "found as offset of x"]


# What the plots hold


def test_signals_are_in_the_channels_own_unit():
    chart = figures(drive())["signals-0"]
    measured = {trace["name"]: trace for trace in chart["data"]}
    assert np.nanmax(unpacked(measured["z"]["y"])) == pytest.approx(180, abs=2)
    assert unpacked(measured["z, stand-in"]["y"]) == pytest.approx(np.degrees(drive().repaired[499:502, 1]), abs=1e-6)
    assert unpacked(measured["x"]["x"])[-1] == pytest.approx(59.98, abs=1e-4)
    assert "deg/s" in measured["x"]["hovertemplate"]
    latitude = figures(drive())["signals-1"]["data"][0]
    assert unpacked(latitude["y"])[0] == pytest.approx(np.degrees(0.9), abs=1e-9)


def test_faults_are_shaded_in_their_own_channel_and_numbered():
    shapes = figures(drive())["signals-0"]["layout"]["shapes"]
    assert [(s["yref"], s["x0"], s["x1"], s["label"]["text"]) for s in shapes] == [
        ("y domain", 30.0, pytest.approx(59.98), "2"),
        ("y2 domain", 10.0, 10.0, "1"),
    ]
    assert figures(drive())["signals-1"]["layout"]["shapes"] == []


def test_verdict_bands_cover_the_log_without_holes():
    detection = drive()
    bars = figures(detection)["verdicts"]["data"]
    gyro = sorted((b, b + w) for t in bars for b, w, y in zip(t["base"], t["x"], t["y"], strict=True) if y < 1)
    assert gyro[0][0] == 0
    assert gyro[-1][1] == pytest.approx(59.98)
    assert all(a[1] == pytest.approx(b[0]) for a, b in pairwise(gyro))
    assert bars[FAULT]["hovertext"] == ["gyro: fault, 0:10.00 to 0:10.02", "gyro: fault, 0:30.00 to 0:40.00"]


def test_fault_of_nobody_has_a_band_of_its_own():
    detection = drive()
    sample = detection.sample.copy()
    sample[2500] = FAULT
    bars = figures(replace(detection, sample=sample))["verdicts"]["data"][FAULT]
    assert bars["hovertext"][-1].startswith("unknown which: fault, 0:50.00")
    assert len(bars["hovertext"]) == 3


def test_scores_that_span_much_are_logarithmic_and_no_limit_is_no_line():
    chart = figures(drive())["scores"]
    assert [chart["layout"][axis]["type"] for axis in ("yaxis", "yaxis2")] == ["log", "linear"]
    limits = [unpacked(trace["y"]) for trace in chart["data"] if trace["name"] == "limit"]
    assert (limits[0] == 3).all()
    assert limits[1].size == 0
    assert np.nanmax(unpacked(chart["data"][1]["y"])) == pytest.approx(1e4)


def test_all_figures_share_the_time_axis():
    assert {tuple(figure["layout"]["xaxis"]["range"]) for figure in figures(drive(), TRUTH).values()} == {(0.0, 59.98)}


# Hostile names, odd logs, failures


def test_names_from_files_stay_names(tmp_path):
    evil = "<script>alert(1)</script>"
    detection = drive(name="</title></script><img src=x>", gyro=evil)
    log = replace(
        detection.log, notes=("<b>note",), channels=(Channel("<i>x", evil, "<u>"), *detection.log.channels[1:])
    )
    named = replace(detection.events[0], channel="<i>x", kind="<s>", method="<s>")
    truth = (Fault("offset", evil, "<i>x", 10.0, 1.0), Fault("offset", evil, "<i>x", 50.0, 1.0))
    traces = (Trace(evil, "<i>x", detection.traces[0].score, detection.traces[0].limit),)
    hostile = replace(
        detection, log=log, watched=(False, False, False), events=(named,), method="</script>", traces=traces
    )
    plain = written(tmp_path, drive(), TRUTH)
    seen = written(tmp_path, hostile, truth, summary=("<b>summary",))
    assert {tag for tag, _ in seen.tags} == {tag for tag, _ in plain.tags}
    assert len(seen.scripts) == 3
    assert seen.rows[0][3:7] == [evil, "<i>x", "<s>", "9.5 / 3"]
    assert "<" not in seen.scripts[0]
    raw = json.dumps(seen.figures)  # Plotly reads a little HTML too
    assert "<i>" not in raw
    assert "<u>" not in raw
    assert "<script" not in raw
    assert "&lt;script" in raw


def test_log_without_faults_and_tests(tmp_path):
    detection = drive()
    quiet = replace(detection, events=(), traces=(), sensor=detection.sensor * 0, sample=detection.sample * 0)
    seen = written(tmp_path, quiet)
    assert "No faults; 1 sensor watched" in seen.text
    assert "No fault was found." in seen.text
    assert "Scores" not in seen.text
    assert "scores" not in seen.figures


def test_log_of_one_row_without_data(tmp_path):
    log = Log(
        np.zeros(1), np.full((1, 1), np.nan), np.zeros((1, 1), dtype=bool), (Channel("x", "a"),), (Sensor("a", np.nan),)
    )
    verdict = np.ones((1, 1), dtype=np.int8)
    seen = written(
        tmp_path, Detection(log, "pca", (False,), verdict, verdict, verdict[:, 0], still(1), log.value, (), ())
    )
    assert seen.figures["signals-0"]["data"] == []
    assert "has no data" in seen.figures["signals-0"]["layout"]["annotations"][0]["text"]
    assert seen.figures["verdicts"]["layout"]["xaxis"]["range"] == [-0.5, 0.5]


def test_a_page_that_fails_leaves_the_old_one(tmp_path, monkeypatch):
    path = tmp_path / "page.html"
    path.write_text("old")

    def broken(*_: object) -> None:
        raise OSError("disk full")

    monkeypatch.setattr("os.replace", broken)
    with pytest.raises(OSError, match="disk full"):
        write_page(drive(), path)
    assert path.read_text() == "old"
    assert os.listdir(tmp_path) == ["page.html"]


@pytest.mark.parametrize("name", ["no/such.html", "folder.html"])
def test_a_page_that_cannot_be_there_is_named_as_the_user_did(tmp_path, name):
    (tmp_path / "folder.html").mkdir()
    with pytest.raises(OSError, match=r"directory") as raised:
        write_page(drive(), tmp_path / name)
    assert raised.value.filename == str(tmp_path / name)
    assert os.listdir(tmp_path) == ["folder.html"]


def test_an_hour_of_twelve_channels_is_a_small_page():
    rows = 180_000
    rng = np.random.default_rng(0)
    sensors = tuple(Sensor(name, 0.02) for name in ("gyro", "accelerometer", "magnetometer", "wheels"))
    channels = tuple(Channel(axis, s.name, "deg/s") for s in sensors for axis in "xyz")
    value = rng.normal(size=(rows, 12))
    log = Log(np.arange(rows) / RATE, value, np.ones((rows, 12), dtype=bool), channels, sensors)
    verdict = rng.integers(0, 3, (rows, 12)).astype(np.int8)
    limit = np.full(rows, 3.0)
    traces = tuple(Trace("norm", c.path, np.abs(value[:, i]), limit) for i, c in enumerate(channels))
    events = tuple(Event(25.0 * i, 25.0 * i + 20, "sensor", "gyro", "x", "offset", 9.0, 3.0, "elm") for i in range(140))
    verdicts = verdict, verdict[:, ::3], verdict[:, 0], still(rows)
    detection = Detection(log, "elm", (True,) * 12, *verdicts, value, traces, events)
    assert len(json.dumps(figures(detection))) < 12e6


def test_importing_the_page_imports_no_plotly():
    code = "import sys, sensorfault.report.page; sys.exit('plotly' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
