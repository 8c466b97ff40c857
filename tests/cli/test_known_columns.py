"""A model knows the columns of its logs; init says what detect will be able to do."""

import json
from pathlib import Path

import numpy as np
import pytest

import fitted
from cli.conftest import Run, write_csv
from logs import written_dataflash
from sensorfault.logs import write
from sensorfault.methods.catalog import DEFAULT


def calm(path: str = "calm.csv") -> Path:
    """A drive so calm that its deg/s might be rad/s; the gyro is tilted by nothing else."""
    rig = fitted.rig().between(120.0, 150.0)
    value = rig.value.copy()
    value[:, :3] *= 0.05
    return write_csv(Path(path), fitted.shifted(rig, value))


def test_the_quick_start_on_a_calm_drive(run: Run, drive: Path) -> None:
    assert run("init", drive).code == 0
    assert run("fit", drive, "--out", "car.sf").code == 0
    for _ in range(2):
        said = run("detect", calm(), "--model", "car.sf")
        assert (said.code, said.out) == (0, ""), said.err
        Path("vehicle.toml").unlink(missing_ok=True)
    assert "Columns are read as the model car.sf knows them." in said.err
    said = run("evaluate", calm(), "--model", "car.sf", "--truth", truth(), "--json", "-")
    assert json.loads(said.out)["false_alarms"] == []
    assert "Columns are read as the model car.sf knows them." in said.err
    assert "0 fault events" in run("report", calm(), "--model", "car.sf").err


def truth() -> Path:
    path = Path("none.truth.json")
    path.write_text("[]")
    return path


@pytest.mark.parametrize("verb", ["detect", "report", "evaluate"])
def test_a_vehicle_file_that_says_otherwise_is_refused(run: Run, drive: Path, car: Path, verb: str) -> None:
    run("init", drive, "--out", "mine.toml")
    text = Path("mine.toml").read_text()
    Path("mine.toml").write_text(text.replace('column = "gyro_y", unit = "deg/s"', 'column = "gyro_y", unit = "rad/s"'))
    said = run(verb, drive, "--model", car, "--vehicle", "mine.toml")
    assert said.code == 2
    assert (
        "by mine.toml the column 'gyro_y' is gyro.y [rad/s], by the model car.sensorfault it is gyro.y [deg/s]; correct"
    ) in said.err


@pytest.mark.parametrize("verb", ["detect", "report", "evaluate"])
def test_a_method_beside_a_model_of_another_is_refused(run: Run, drive: Path, car: Path, verb: str) -> None:
    said = run(verb, drive, "--model", car, "--method", "pca")
    assert said.code == 2
    assert f"car.sensorfault is a model of {DEFAULT}, not of pca; leave out --method, or --model." in said.err
    if verb == "detect":
        assert run(verb, drive, "--model", car, "--method", DEFAULT).code == 0


def test_init_says_how_sure_it_is(run: Run) -> None:
    said = run("init", calm(), "--json", "-")
    gyro, acc = (json.loads(said.out)["sensors"][name][0] for name in ("gyro", "accelerometer"))
    assert (gyro["sure"], acc["sure"]) == ("a guess", "likely")
    assert "  gyro: x, y, z [rad/s] - a guess: its 95th percentile is" in said.err
    assert "  accelerometer: x, y, z [m/s^2] - likely: its usual length" in said.err
    assert "# a guess: its 95th percentile is" in Path("vehicle.toml").read_text()


def test_init_promises_what_detect_then_does(run: Run, drive: Path) -> None:
    promised = json.loads(run("init", drive, "--json", "-").out)["detect"]
    assert promised["refuses"] is None
    assert promised["alone"] == ["gyro", "accelerometer"]
    made = json.loads(run("fit", drive, "--method", DEFAULT, "--held-out", 0, "--until", 40, "--json", "-").out)
    assert f"{DEFAULT} judges {', '.join(made['watched'])}, each by itself." in promised["checks"][0]
    assert "Checked for dropouts only: east_m.east_m, north_m.north_m (marked watch = false)." in promised["checks"]
    assert run("detect", drive).code == 0


def test_init_of_a_flight_promises_what_detect_compares(run: Run, tmp_path: Path) -> None:
    path = Path("flight.bin")
    path.write_bytes(written_dataflash.flight(seconds=60.0))
    promised = json.loads(run("init", path, "--json", "-").out)["detect"]
    assert len(promised["compared"]) > 1
    err = run("detect", path).err
    assert all(sentence in err for sentence in promised["checks"])


@pytest.mark.parametrize("what", ["three rows", "two rows"])
def test_init_says_that_detect_will_refuse(run: Run, what: str) -> None:
    rig = fitted.rig().between(end_s=0.05 if what == "three rows" else 0.03)
    path = write_csv(Path("odd.csv"), rig)
    said = run("init", path)
    assert said.code == 0
    refused = run("detect", path)
    assert refused.code == 2
    reason = refused.err.strip().splitlines()[-1].removeprefix("sensorfault: ")
    assert f"'sensorfault detect odd.csv' will refuse this log as it is described: {reason}" in said.err


def test_init_names_the_file_that_it_wrote(run: Run, drive: Path) -> None:
    assert "'sensorfault detect drive.csv --vehicle car.toml'" in run("init", drive, "--out", "car.toml").err
    assert "'sensorfault detect drive.csv'" in run("init", drive).err


def test_a_pause_is_said_once(run: Run) -> None:
    rig = fitted.rig().between(end_s=80.0)
    write(rig.without(np.arange(2500, 2700)), "paused.csv")
    said = run("detect", "paused.csv")
    assert (said.code, said.out) == (0, ""), said.err
    assert said.err.count("The recording has 1 gap, 4.02 s in all, the longest 4.02 s at 49.980 s") == 1
    result = json.loads(run("info", "paused.csv", "--json", "-").out)
    assert result["pauses"] == [[pytest.approx(49.98), pytest.approx(54.0)]]
    assert [sensor["gaps"] for sensor in result["sensors"]] == [0, 0, 0]


def test_a_log_too_short_to_judge_is_not_without_faults(run: Run, drive: Path, car: Path) -> None:
    Path("two.csv").write_text("".join(drive.read_text().splitlines(keepends=True)[:3]))
    said = run("detect", "two.csv", "--model", car, "--json", "two.json")
    assert said.code == 0
    assert "Faults in two: unknown, as none of its 2 rows could be judged; it is too short to judge" in said.err
    assert "none." not in said.err
    assert json.loads(Path("two.json").read_text())["judged"] is False
    assert run("detect", drive, "--model", car, "--json", "all.json").code == 0
    assert json.loads(Path("all.json").read_text())["judged"] is True
