"""The handful of methods that users choose among by name."""

import gzip
import json
from pathlib import Path

import numpy as np
import pytest

from cli.conftest import Run
from relations import drives
from sensorfault import fit
from sensorfault.logs import Log, LogError, read
from sensorfault.logs.readers import gzipped
from sensorfault.methods.catalog import METHODS, recipe
from sensorfault.runtime.compared import Comparison
from sensorfault.runtime.names import CHANNELS, VEHICLES
from sensorfault.runtime.store import load


@pytest.fixture
def car(tmp_path: Path) -> Path:
    log = drives.car(120.0)
    path = tmp_path / "car.csv"
    log.frame().write_csv(path)
    return path


def test_the_list_is_short_unless_all_are_asked_for(run: Run) -> None:
    short, whole = run("methods"), run("methods", "--all")
    assert all(name in short.out for name in (*VEHICLES, *CHANNELS))
    assert "lof-efd" not in short.out
    assert "lof-efd" in whole.out
    assert not {*VEHICLES, *CHANNELS} & METHODS.keys()
    listed = json.loads(run("methods", "--json", "-").out)["methods"]
    assert {one["name"] for one in listed} == {*VEHICLES, *CHANNELS, *METHODS}


def test_a_class_can_be_named(run: Run, car: Path, tmp_path: Path) -> None:
    model = tmp_path / "car.sensorfault"
    run("fit", str(car), "--method", "car", "--out", str(model))
    known = load(model)
    assert isinstance(known, Comparison)
    assert known.learned is not None
    assert known.learned.vehicle == "car"
    assert "none" in run("detect", str(car), "--model", str(model), "--method", "car").err
    refused = run("detect", str(car), "--model", str(model), "--method", "drone")
    assert refused.code == 2
    assert "is a model of a car, not of a drone" in refused.err


def test_drone_is_one_of_two() -> None:
    for log, vehicle in ((drives.copter(100.0), "copter"), (drives.car(100.0), "copter")):
        known = fit(log, "drone")
        assert isinstance(known, Comparison)
        assert known.learned is not None
        assert known.learned.vehicle == vehicle


def test_former_names_of_recipes_are_recipes() -> None:
    assert {name: recipe(name).name for name in ("car", "drone", "rail", "train")} == {
        "car": "car-composite", "drone": "drone-composite", "rail": "satellite-bank", "train": "satellite-bank"
    }  # fmt: skip


def test_a_name_that_is_none_is_said_before_the_log_is_read(run: Run) -> None:
    said = run("detect", "not-there.csv", "--method", "carr")
    assert said.code == 2
    assert "did you mean car?" in said.err
    with pytest.raises(LogError, match="take one of auto, car"):
        recipe("xyzzy")


def test_imu_and_arm_are_recipes(car: Path) -> None:
    log = read(car)
    assert isinstance(log, Log)
    assert np.isfinite(log.value).any()
    assert fit(log, "imu", held_out=0.0).method == "relative-conditioning"


def test_how_large_a_packed_log_may_be(run: Run, car: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gzipped, "most", gzipped.Most())
    packed = car.with_suffix(".csv.gz")
    packed.write_bytes(gzip.compress(car.read_bytes()))
    refused = run("detect", packed, "--max-size", "10kB")
    assert refused.code == 2
    assert "larger than 1e-05 GB" in refused.err
    assert run("detect", packed, "--max-size", "1 GB").code == 0
    assert "is no size" in run("detect", packed, "--max-size", "much").err
