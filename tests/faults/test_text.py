import json

import pytest

from faults.example import example
from sensorfault.faults.fault import Fault, FaultError
from sensorfault.faults.text import parse_fault, truth_from_json, truth_to_json

BIAS = {"kind": "offset", "sensor": "gyro", "channel": "z", "start_s": 1, "duration_s": 2.5, "magnitude": 3.0}


@pytest.mark.parametrize(
    ("text", "fault"),
    [
        ("offset:gyro.z:120:20:5sigma", Fault("offset", "gyro", "z", 120.0, 20.0, 5.0, sigmas=True)),
        ("spike:gyro:1.5:0:-2", Fault("spike", "gyro", None, 1.5, 0.0, -2.0)),
        ("drift:gnss.latitude:3:60:1e-5", Fault("drift", "gnss", "latitude", 3.0, 60.0, 1e-5)),
        ("frozen:gnss:3:60", Fault("frozen", "gnss", None, 3.0, 60.0)),
        ("scale:gyro.x:3:60:0", Fault("scale", "gyro", "x", 3.0, 60.0, 0.0)),
        (" noise : gyro.x : 3 : 60 : 2 sigmas ", Fault("noise", "gyro", "x", 3.0, 60.0, 2.0, sigmas=True)),
    ],
)
def test_text_becomes_a_fault(text: str, fault: Fault) -> None:
    assert parse_fault(text) == fault


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("offset:gyro.z:5", "has 3 parts; write kind:sensor"),
        ("melt:gyro.z:5:1", "kind 'melt' is unknown; take one of spike, offset"),
        ("offset:gyro.q:5:1:2", "no channel 'q'; take one of x, z"),
        ("offset:gps:5:1:2", "no sensor is called 'gps'"),
        ("offset::5:1:2", "names no sensor"),
        ("offset:gyro.z:99:1:2", "lies outside the log"),
        ("offset:gyro.z:5:-1:2", "is negative"),
        ("offset:gyro.z:5:1", "kind offset needs a magnitude"),
        ("scale:gyro.z:5:1:", "kind scale needs a magnitude"),
        ("offset:gyro.z:5:1:sigma", "magnitude '' is not a number"),
        ("offset:gyro.z:5:1:big", "magnitude 'big' is not a number"),
        ("offset:gyro.z:soon:1:2", "onset 'soon' is not a number"),
        ("offset:gyro.z:5:inf:2", "finite"),
        ("frozen:gyro.z:5:1:2", "kind frozen has no magnitude"),
        ("delay:gyro.z:5:1:2sigma", "cannot be in sigmas"),
    ],
)
def test_text_that_is_no_fault_is_refused_in_a_sentence(text: str, sentence: str) -> None:
    with pytest.raises(FaultError) as caught:
        parse_fault(text, example())
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)


def test_truth_comes_back_from_json() -> None:
    truth = (parse_fault("offset:gyro.z:0.1:0.2:5sigma"), parse_fault("frozen:gnss:3:60"))
    assert truth_from_json(truth_to_json(truth)) == truth
    assert json.loads(truth_to_json(truth))[1]["channel"] is None


@pytest.mark.parametrize(
    ("entries", "sentence"),
    [
        ({"kind": "offset"}, "is a JSON dict"),
        ([3], "Fault 1 of the truth is not a JSON object"),
        ([BIAS, {"kind": "offset"}], "Fault 2 of the truth has no field 'sensor'"),
        ([BIAS | {"size": 1}], "unknown field 'size'"),
        ([BIAS | {"start_s": "1"}], "'start_s' is \"1\""),
        ([BIAS | {"magnitude": True}], "'magnitude' is true"),
        ([BIAS | {"kind": "melt"}], "kind 'melt' is unknown"),
        ([BIAS | {"duration_s": float("nan")}], "finite"),
    ],
)
def test_foreign_truth_is_refused_in_a_sentence(entries: object, sentence: str) -> None:
    with pytest.raises(FaultError) as caught:
        truth_from_json(json.dumps(entries))
    assert sentence in str(caught.value)


def test_what_is_not_json_is_refused_with_its_line() -> None:
    with pytest.raises(FaultError, match="line 2"):
        truth_from_json("[\n")
