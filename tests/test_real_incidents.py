"""The default, without a model, on real incidents and on healthy logs of the same kinds of vehicles."""

import json
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from sensorfault.events.event import Event
from sensorfault.logs import read
from sensorfault.runtime.compared import compare
from sensorfault.runtime.result import Detection

pytestmark = pytest.mark.real
NAMES = {"gnss": "gnss", "magnetometer": "magnetometer", "barometer": "barometer", "accelerometer": "accelerometer"}
KNOWN = frozenset({"pitot"})  # labels of sensors that no relation has yet


def labels(data: Path) -> list[dict[str, Any]]:
    """Labels that name a sensor."""
    every = json.loads((data / "incidents" / "labels.json").read_text())
    return [label for label in every if label["sensor"] and label["sensor"] not in KNOWN]


@cache
def found(path: Path) -> Detection:
    return compare(read(path))


def during(event: Event, label: dict[str, Any]) -> bool:
    return event.start_s <= label["end_s"] and (event.end_s is None or event.end_s >= label["start_s"])


def test_labelled_lies_are_found_and_named(real_data: Path) -> None:
    missed, late = [], []
    for label in labels(real_data):
        events = found(real_data / "incidents" / label["log"]).events
        named = [e for e in events if e.sensor and NAMES[label["sensor"]] in e.sensor and during(e, label)]
        if not named:
            missed.append(label)
        elif min(e.start_s for e in named) > label["start_s"] + 10:
            late.append(label)
    assert missed == []
    assert len(late) <= 2


def test_nobody_else_is_accused(real_data: Path) -> None:
    wrong = []
    for log in {label["log"] for label in labels(real_data)}:
        mine = [NAMES[label["sensor"]] for label in labels(real_data) if label["log"] == log]
        events = found(real_data / "incidents" / log).events
        wrong += [(log, str(e)) for e in events if e.sensor and not any(name in e.sensor for name in mine)]
    assert wrong == []


def test_an_actuator_is_no_sensor(real_data: Path) -> None:
    for path in sorted((real_data / "incidents" / "alfa_fixedwing_actuators").glob("*.csv")):
        assert [e for e in found(path).events if e.sensor] == []
    assert found(real_data / "incidents" / "ardupilot_loganalyzer" / "mechanical_fail.log").events == ()


HEALTHY = (
    "road/dresden_50hz",
    "road/gnss_imu_drive0708",
    "road/comma2k19_rav4",
    "uav/px4_fw_proto_flt09",
    "uav/umn_fw_thor75",
    "uav/copter_jd2014/jd_200424.bin",
    "uav/copter_jd2014/jd_204405.bin",
    "uav/copter_jd2014/jd_211907.bin",
    "uav/pyulog_sample/sample.ulg",
    *(f"healthy/quad_v413_goodprop/good_prop_{name}.BIN" for name in ("hover_1", "hover_3", "straight_line_1")),
    *(f"healthy/quad_v413_goodprop/good_prop_straight_line_{n}.BIN" for n in (2, 3)),
    "healthy/quad_erle_pxf_2014/5-12-2014_218.BIN",
)


@pytest.mark.parametrize("log", HEALTHY)
def test_healthy_logs_are_silent(log: str, real_data: Path) -> None:
    """The class table was made from these logs, so this is no rate of false alarms; it keeps what was reached."""
    events = [e for e in found(real_data / log).events if not (e.kind == "missing" and e.start_s > 540)]
    assert events == []
