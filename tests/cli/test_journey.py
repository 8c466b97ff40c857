"""The whole way of a user, from an unknown CSV to a report, on a small drive."""

import json
from pathlib import Path

import pytest

from cli.conftest import Run, Said
from sensorfault.methods.catalog import METHODS
from sensorfault.runtime.names import CHANNELS, VEHICLES

KEYS = {"start_s", "end_s", "subject", "sensor", "channel", "kind", "peak_score", "limit", "method"} | {
    "found_by",
    "candidates",
}
FAULTS = ("spike:gyro.x:61:0:30sigma", "offset:gyro.z:64:3:20sigma", "frozen:accelerometer.x:70:3", "missing:gyro:76:2")


def injected(run: Run, drive: Path) -> Said:
    options = [word for fault in FAULTS for word in ("--fault", fault)]
    said = run("inject", drive, *options, "--out", "bad.csv", "--json", "-")
    assert said.code == 0, said.err
    return said


def test_from_an_unknown_file_to_a_report(run: Run, drive: Path, tmp_path: Path) -> None:
    # init
    said = run("init", drive)
    assert said.code == 0, said.err
    assert said.out == ""
    assert "gyro: x, y, z [deg/s] - likely: its 95th percentile is" in said.err
    assert "relative-conditioning judges gyro.x, gyro.y, gyro.z, accelerometer.x" in said.err
    assert "Checked for dropouts only: east_m.east_m, north_m.north_m" in said.err
    text = (tmp_path / "vehicle.toml").read_text()
    assert "[sensor.accelerometer]" in text
    assert text.count("#") > 5  # each guess with its reason

    # fit
    said = run("fit", drive, "--until", 60, "--out", "car.sensorfault", "--json", "fit.json")
    assert said.code == 0, said.err
    assert "False alarms on the part held out: none in 18 s: too short to promise a rate." in said.err
    result = json.loads((tmp_path / "fit.json").read_text())
    assert result["method"] == "relative-conditioning"
    assert result["alarms_per_hour"] == 0
    assert len(result["watched"]) == 6

    # inject
    result = json.loads(injected(run, drive).out)
    assert [fault["kind"] for fault in result["truth"]] == ["spike", "offset", "frozen", "missing"]
    assert json.loads((tmp_path / "bad.truth.json").read_text()) == result["truth"]

    # detect, into a file and to standard output
    said = run("detect", "bad.csv", "--model", "car.sensorfault", "--json", "found.json", "--report", "page.html")
    assert said.code == 0, said.err
    assert "1:04.00" in said.out
    again = run("detect", "bad.csv", "--model", "car.sensorfault", "--json", "-")
    found = json.loads(again.out)
    assert found == json.loads((tmp_path / "found.json").read_text())
    assert "1:04.00" in again.err  # the table makes room
    assert all(set(event) == KEYS for event in found["events"])
    for fault in result["truth"]:
        during = [e for e in found["events"] if fault["start_s"] <= e["start_s"] <= fault["start_s"] + 1]
        assert (fault["sensor"], fault["channel"], fault["kind"]) in [
            (event["sensor"], event["channel"], event["kind"]) for event in during
        ]
    page = (tmp_path / "page.html").read_text()
    assert page.startswith("<!")
    assert "accelerometer" in page

    # evaluate
    said = run("evaluate", "bad.csv", "--model", "car.sensorfault", "--truth", "bad.truth.json", "--json", "-")
    assert said.code == 0, said.err
    result = json.loads(said.out)
    assert [outcome["found"] for outcome in result["outcomes"]] == [True] * 4
    assert [outcome["sensor_right"] for outcome in result["outcomes"]] == [True] * 4
    assert result["false_alarms_per_hour"] == 0
    assert "False alarms where nothing was injected: none in " in said.err

    # report
    said = run("report", "bad.csv", "--model", "car.sensorfault", "--truth", "bad.truth.json", "--out", "why.html")
    assert said.code == 0, said.err
    assert said.out == ""
    assert (tmp_path / "why.html").read_text().startswith("<!")

    made = {"bad.csv", "bad.truth.json", "bad.vehicle.toml", "car.sensorfault", "drive.csv", "fit.json"}
    made |= {"found.json", "page.html", "vehicle.toml", "why.html"}
    assert {file.name for file in tmp_path.iterdir()} == made


def test_detect_without_a_model_says_what_that_means(run: Run, drive: Path) -> None:
    said = run("detect", drive, "--json", "-")
    assert said.code == 0, said.err
    assert "No model was given: relative-conditioning was fitted on 0:00.00 to 0:39.99 of this log" in said.err
    assert "assumed healthy" in said.err
    assert "the false-alarm rate is unknown" in said.err
    result = json.loads(said.out)
    assert result["events"] == []
    assert result["fitted_on_s"] == [0.0, pytest.approx(39.99)]
    assert result["judged_s"][0] >= result["fitted_on_s"][1]
    assert result["log"] == "drive"


def test_detect_says_that_columns_were_guessed(run: Run, drive: Path, car: Path) -> None:
    guessed = run("detect", drive, "--method", "pca")
    assert guessed.code == 0, guessed.err
    assert "No vehicle.toml: sensors, units and held values are guesses" in guessed.err
    guessed = run("detect", drive, "--model", car)
    assert guessed.code == 0, guessed.err
    assert "as the model car.sensorfault knows them, by a guess; `sensorfault init`" in guessed.err
    assert guessed.out == ""
    assert "none" in guessed.err
    run("init", drive)
    described = run("detect", drive, "--model", car)
    assert "guess" not in described.err


def test_evaluate_without_a_truth_injects_one(run: Run, drive: Path, car: Path) -> None:
    said = run("evaluate", drive, "--model", car, "--duration", 2, "--repeats", 1, "--json", "-")
    assert said.code == 0, said.err
    result = json.loads(said.out)
    assert {cell["kind"] for cell in result["cells"]} == {
        *("spike", "offset", "drift", "frozen", "missing", "noise", "scale", "delay"),
    }
    assert result["false_alarms_per_hour"] == 0
    assert result["healthy_hours"] == pytest.approx(80 / 3600, rel=0.01)
    assert 0.5 < result["auc"] <= 1
    assert set(result["isolation"]) <= {"gyro", "accelerometer", "east_m", "north_m", "gnss"}


def test_evaluate_leaves_out_faults_in_the_part_fitted_on(run: Run, drive: Path) -> None:
    assert (
        run("inject", drive, "--fault", "missing:gyro:20:2", "--fault", "missing:gyro:60:2", "--out", "bad.csv").code
        == 0
    )
    said = run("evaluate", "bad.csv", "--truth", "bad.truth.json", "--json", "-")
    assert said.code == 0, said.err
    assert "1 fault in the part that was fitted on: not evaluated." in said.err
    assert [outcome["fault"]["start_s"] for outcome in json.loads(said.out)["outcomes"]] == [60.0]


def test_faults_in_the_training_data_are_named_and_left_out(run: Run, drive: Path, tmp_path: Path) -> None:
    faults = [
        word for fault in ("spike:gyro.x:20:0:200sigma", "frozen:accelerometer.y:30:3") for word in ("--fault", fault)
    ]
    assert run("inject", drive, *faults, "--out", "bad.csv").code == 0
    said = run("fit", "bad.csv", "--until", 60, "--out", "car.sensorfault", "--json", "fit.json")
    assert said.code == 0, said.err
    assert "Left out of the fit because it looks faulty: spike on gyro.x, 0:20.00 to 0:20.00" in said.err
    result = json.loads((tmp_path / "fit.json").read_text())["training_suspects"]
    assert [(one["channel"], one["reason"]) for one in result] == [("gyro.x", "spike"), ("accelerometer.y", "frozen")]


def test_the_catalog(run: Run) -> None:
    said = run("methods", "--json", "-")
    assert said.code == 0
    assert said.err == ""
    result = json.loads(said.out)["methods"]
    assert [method["name"] for method in result] == [*VEHICLES, *CHANNELS, *METHODS]
    assert all(set(method) == {"name", "title", "source", "false_alarm_rate"} for method in result)
    table = run("methods", "--all")
    assert "elm-autoencoder" in table.out
    assert "Min et al. 2021" in table.out


def test_the_other_method(run: Run, drive: Path, tmp_path: Path) -> None:
    said = run("fit", drive, "--method", "pca", "--held-out", 0.2, "--json", "-")
    assert said.code == 0, said.err
    assert json.loads(said.out)["model"] == "drive.sensorfault"
    said = run("detect", drive, "--model", "drive.sensorfault", "--json", "-")
    assert json.loads(said.out)["method"] == "pca"


def test_json_has_no_nan(run: Run, drive: Path, car: Path) -> None:
    """A miss has no AUC, an undetected fault no delay: null, as JSON knows no other."""
    assert run("inject", drive, "--fault", "offset:gyro.x:70:1:0.001", "--out", "bad.csv").code == 0
    said = run("evaluate", "bad.csv", "--model", car, "--truth", "bad.truth.json", "--json", "-")
    assert "NaN" not in said.out
    (outcome,) = json.loads(said.out)["outcomes"]
    assert (outcome["found"], outcome["delay_s"]) == (False, None)


def test_the_same_words_give_the_same_answer(run: Run, drive: Path) -> None:
    one, two = (run("detect", drive, "--learn", 0.6, "--seed", 3, "--json", "-").out for _ in range(2))
    assert json.loads(one) == json.loads(two)


def test_a_flight_as_a_demo(run: Run, tmp_path: Path) -> None:
    """The receiver's height drifts, jumps; the barometer falls silent. All three are found, and nobody else accused."""
    said = run("demo", "--flight", "--out", "wing", "--json", "wing.json")
    assert said.code == 0
    assert "3 of 3 injected faults found" in said.err + said.out
    events = json.loads((tmp_path / "wing.json").read_text())["events"]
    assert {event["sensor"] for event in events} == {"gnss", "barometer"}
    assert (tmp_path / "wing" / "flight.csv").exists()
    assert (tmp_path / "wing" / "report.html").exists()


def test_events_for_other_programs(run: Run, drive: Path, car: Path, tmp_path: Path) -> None:
    assert run("inject", drive, "--fault", "offset:gyro.z:64:3:20sigma", "--out", "bad.csv").code == 0
    outs = ["events.jsonl", "events.csv", "events.mcap", "events.bag", "events_bag"]
    options = [word for out in outs for word in ("--out", out)]
    said = run("detect", "bad.csv", "--model", car, *options, "--json", "found.json")
    assert said.code == 0, said.err
    assert all((tmp_path / out).exists() for out in outs)
    found = json.loads((tmp_path / "found.json").read_text())["events"]
    assert [json.loads(line) for line in (tmp_path / "events.jsonl").read_text().splitlines()] == found
    said = run("detect", "bad.csv", "--model", car, "--out", "events.doc")
    assert said.code == 2
    assert "events are written as" in said.err
    assert run("detect", "bad.csv", "--model", car, "--out", "bad.csv").code == 2
