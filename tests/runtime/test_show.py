"""What a person sees who types a name: one line; in a notebook, small tables that suit every theme."""

import re
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest

import fitted
from sensorfault.core.times import clock
from sensorfault.events.event import Event
from sensorfault.faults.fault import Fault
from sensorfault.logs.table import Channel, Sensor
from sensorfault.methods.catalog import METHODS
from sensorfault.runtime.detect import Live

OFFSET = Event(52.1, 67.1, "sensor", "gyro", "z", "offset", 12.34, 4.1, "pca")


class Cells(HTMLParser):
    """Tags, attributes and the rows of all tables; fails where a tag is left open."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.seen: list[tuple[str, object]] = []
        self.rows: list[list[str]] = []
        self.feed(text)
        assert not self.open

    def handle_starttag(self, tag, attrs):
        self.open.append(tag)
        self.seen.append((tag, attrs))
        if tag == "tr":
            self.rows.append([])
        if tag in ("td", "th"):
            self.rows[-1].append("")

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        if self.open[-1:] in (["td"], ["th"]):
            self.rows[-1][-1] += data


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (0.0, "0:00.00"),
        (52.1, "0:52.10"),
        (59.999, "1:00.00"),
        (4500.0, "1:15:00.00"),
        (-49.65, "-0:49.65"),
        (-3599.999, "-1:00:00.00"),
    ],
)
def test_seconds_as_a_person_reads_them(seconds: float, text: str) -> None:
    assert clock(seconds) == text


@pytest.mark.parametrize(
    ("event", "text"),
    [
        (OFFSET, "0:52.10-1:07.10 offset of gyro.z (peak 12.3, limit 4.1)"),
        (replace(OFFSET, end_s=None, channel=None), "0:52.10-ongoing offset of gyro (peak 12.3, limit 4.1)"),
        (replace(OFFSET, end_s=52.1, kind="spike"), "0:52.10 spike of gyro.z (peak 12.3, limit 4.1)"),
        (replace(OFFSET, kind="missing"), "0:52.10-1:07.10 missing of gyro.z (peak 12.3 s, limit 4.1 s)"),
        (
            replace(OFFSET, sensor=None, channel=None, kind="unknown"),
            "0:52.10-1:07.10 fault, unknown which (peak 12.3, limit 4.1)",
        ),
        (
            replace(OFFSET, sensor=None, channel=None, kind="missing", peak_score=None, limit=None),
            "0:52.10-1:07.10 missing of the whole log",
        ),
        (
            replace(OFFSET, subject="motion", sensor=None, channel=None, kind="unknown"),
            "0:52.10-1:07.10 fault of vehicle motion (peak 12.3, limit 4.1)",
        ),
    ],
)
def test_an_event_in_one_line(event: Event, text: str) -> None:
    assert str(event) == text
    assert repr(event) == f"<Event {text}>"


@pytest.mark.parametrize(
    ("fault", "text"),
    [
        (Fault("offset", "gyro", "z", 52.1, 15.0, 0.5), "0:52.10-1:07.10 offset of gyro.z (0.5)"),
        (Fault("spike", "gyro", None, 52.1, 0.0, 20.0, sigmas=True), "0:52.10 spike of gyro (20 sigma)"),
        (Fault("frozen", "gyro", "z", 52.1, 15.0), "0:52.10-1:07.10 frozen of gyro.z"),
        (Fault("scale", "gyro", "z", 52.1, 15.0, 2.0), "0:52.10-1:07.10 scale of gyro.z (2x)"),
        (Fault("delay", "gyro", "z", 52.1, 15.0, 0.5), "0:52.10-1:07.10 delay of gyro.z (0.5 s)"),
    ],
)
def test_a_fault_in_one_line(fault: Fault, text: str) -> None:
    assert repr(fault) == f"<Fault {text}>"


def test_log_model_and_detection_in_one_line() -> None:
    log, found = fitted.rig(), fitted.found()
    assert repr(log) == "<Log 'rig 0': 10000 rows in 3:19.98 at 50 Hz, sensors gyro, accelerometer, gnss>"
    assert repr(log.between(end_s=0.0)) == "<Log 'rig 0': 0 rows in 0:00.00, sensors gyro, accelerometer, gnss>"
    model = repr(fitted.model("relative-conditioning"))
    assert model == (
        "<Model relative-conditioning fitted on 'rig 0' (1:39.98) at 50 Hz, sensors gyro, accelerometer, gnss>"
    )
    assert repr(found).startswith(f"<Detection 'rig 0': {len(found.events)} events (")
    assert repr(found).endswith(") in 1:39.98 by elm-autoencoder, sensors gyro, accelerometer, gnss>")
    for count, kind in re.findall(r"(\d+) (\w+)[,)]", repr(found)):
        assert sum(event.kind == kind for event in found.events) == int(count)


def test_nothing_prints_arrays() -> None:
    model, found = fitted.model(), fitted.found()
    live = Live(model)
    live.push(0.0, fitted.unseen().value[0])
    assert repr(live).startswith("<Live at 0:00.00, 0 events ended and 0 ongoing: <Model elm-autoencoder")
    for thing in (live, model.monitor, found.traces[0], fitted.lying(), *METHODS.values()):
        assert len(repr(thing)) < 300
        assert "\n" not in repr(thing)
        assert "array" not in repr(thing)


def test_of_many_sensors_the_first_are_named() -> None:
    names = [f"G{i:02d}" for i in range(40)]
    one = fitted.rig().between(end_s=1.0)
    log = replace(
        one,
        value=np.ones((len(one), 40)),
        fresh=np.ones((len(one), 40), bool),
        channels=tuple(Channel("pseudorange_m", name) for name in names),
        sensors=tuple(Sensor(name, 0.02) for name in names),
    )
    assert repr(log).endswith("G06, G07 and 32 others>")
    assert log._repr_html_().count("<tr>") == 21
    assert "and 20 more" in log._repr_html_()


def test_notebooks_show_tables_without_scripts_files_or_colours() -> None:
    things = [fitted.rig(), fitted.model(), fitted.found(), OFFSET, Fault("frozen", "gyro", "z", 52.1, 15.0)]
    for thing in things:
        text = thing._repr_html_()
        assert {tag for tag, _ in Cells(text).seen} <= {"div", "p", "b", "table", "thead", "tbody", "tr", "th", "td"}
        assert all(not attributes for _, attributes in Cells(text).seen)  # no style, no source, no handler


def test_the_tables_say_what_is_so() -> None:
    found = fitted.found()
    rows = Cells(fitted.rig()._repr_html_()).rows
    assert ["gnss", "east [m], north [m]", "0.1 s", "yes", "100%"] in rows
    assert ["gnss", "", "east [m], north [m]"] in Cells(fitted.model()._repr_html_()).rows
    rows = Cells(found._repr_html_()).rows
    assert rows[1] == ["1:45.00", "1:45.00", "gyro.x", "spike", "5.37", "0.0377", "elm-autoencoder"]
    share = np.mean(found.sensor[:, 0] == 2)
    assert [row[-1] for row in rows if row[0] == "gyro"] == [f"{share:.1%}"]


def test_names_from_files_stay_names() -> None:
    evil = "<script>alert(1)</script>"
    found = fitted.found()
    sensors = tuple(replace(sensor, name=evil) if sensor.name == "gyro" else sensor for sensor in found.log.sensors)
    channels = tuple(replace(c, sensor=evil, name=evil) if c.sensor == "gyro" else c for c in found.log.channels)
    log = replace(found.log, name=evil, sensors=sensors, channels=channels, notes=(evil,))
    events = (replace(OFFSET, sensor=evil, channel=evil, kind=evil, method=evil),)
    fault = Fault("frozen", evil, evil, 0.0, 1.0)
    model = replace(fitted.model(), channels=channels, sensors=sensors, method=evil)
    for thing in (log, replace(found, log=log, events=events, method=evil), events[0], fault, model):
        assert "<script" not in thing._repr_html_()
        assert "&lt;script&gt;" in thing._repr_html_()


def test_equality_and_fields_are_as_before() -> None:
    assert replace(OFFSET) == OFFSET
    assert replace(OFFSET, limit=4.0) != OFFSET
    names = "start_s end_s subject sensor channel kind peak_score limit method found_by candidates"
    assert " ".join(OFFSET.as_dict()) == names
    fault = Fault("frozen", "gyro", "z", 52.1, 15.0)
    assert Fault(**fault.as_dict()) == fault
    assert hash(replace(OFFSET)) == hash(OFFSET)
