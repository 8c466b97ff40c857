"""`info`: what a log holds and which methods can watch it."""

import json
from dataclasses import astuple, replace
from pathlib import Path

import numpy as np
import pytest

import fitted
from cli.conftest import Run
from logs.written_ros import mcap
from logs.written_ulog import flight
from sensorfault.logs import summary
from sensorfault.logs.summary import Summing, summarise
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.catalog import METHODS
from sensorfault.training.session import Session


def test_what_a_log_holds(run: Run, tmp_path: Path) -> None:
    (tmp_path / "flight.ulg").write_bytes(flight()[:-3])
    said = run("info", "flight.ulg", "--json", "info.json")
    assert said.code == 0, said.err
    assert "breaks off inside a message at byte" in said.err
    result = json.loads((tmp_path / "info.json").read_text())
    assert result["damage"][0].startswith("flight.ulg: the file breaks off")
    sensors = {sensor["name"]: sensor for sensor in result["sensors"]}
    assert sensors["barometer"]["rate_hz"] == pytest.approx(10)
    assert sensors["gyro"]["gaps"] == 0
    assert result["duration_s"] == pytest.approx(9.98, abs=0.03)
    assert "slope" in result["applies"]
    assert "two joints" in result["does_not_apply"]["arm-kalman"]
    assert set(result["applies"]) | set(result["does_not_apply"]) == set(METHODS)
    assert "drone-composite" in result["applies"]
    assert "arm-kalman" in said.out


def test_a_stock_log_from_init_to_detect(run: Run, tmp_path: Path) -> None:
    name = "flight.ulg"
    (tmp_path / name).write_bytes(flight(20.0))
    assert run("init", name).code == 0
    assert "a log of" in (tmp_path / "vehicle.toml").read_text()
    said = run("fit", name, "--method", "pca", "--out", "model.sensorfault")
    assert said.code == 0, said.err
    assert "guesses" not in said.err  # vehicle.toml is taken as it is
    assert "gyro.x" in said.err
    assert run("detect", name, "--model", "model.sensorfault").code == 0


@pytest.mark.real
@pytest.mark.parametrize("name", ["pyulog_sample/sample.ulg", "copter_jd2014/jd_200424.bin"])
def test_a_real_stock_log_from_init_to_detect(run: Run, real_data: Path, tmp_path: Path, name: str) -> None:
    path = tmp_path / Path(name).name
    path.symlink_to(real_data / "uav" / name)
    assert run("init", path).code == 0
    said = run("fit", path, "--method", "pca", "--out", "model.sensorfault")
    assert said.code == 0, said.err
    assert "guesses" not in said.err
    assert run("detect", path, "--model", "model.sensorfault").code == 0
    result = run("info", path, "--json", "-")
    assert "relative-conditioning" in json.loads(result.out)["applies"]


def test_gaps_and_holds_of_a_sensor() -> None:
    rig = fitted.rig().between(end_s=20.0)
    log = replace(rig, value=rig.value.copy(), fresh=rig.fresh.copy())
    columns = list(log.of("gyro"))
    log.fresh[200:260, columns], log.value[200:260, columns] = False, np.nan
    log.fresh[300:340, columns] = False
    log.fresh[350:351, columns], log.fresh[360:364, columns] = False, False
    gyro = next(one for one in summarise(log) if one.name == "gyro")
    assert gyro.gaps == 3
    assert gyro.gap_at_s == pytest.approx(log.time[199])
    assert gyro.longest_gap_s == pytest.approx(log.time[260] - log.time[199])
    assert gyro.missing == pytest.approx(60 / len(log))
    assert gyro.held == pytest.approx(45 / (len(log) - 60))


def test_parts_of_a_log_sum_up_to_the_whole(monkeypatch: pytest.MonkeyPatch) -> None:
    rig = fitted.rig().between(end_s=20.0)
    log = replace(rig, fresh=rig.fresh.copy())
    for sensor in log.sensors:  # silent for a while, from the last row of a part on
        log.fresh[650:700, list(log.of(sensor.name))] = False
    log = log.without(np.arange(450, 500))  # a pause of the recording that begins with the last row of a part
    whole = summarise(log)
    assert all(one.gaps == 1 for one in whole)
    (pause,) = log.pauses
    for most in (100, 800, 1 << 20):  # the usual step is known before the gap, after it, or at the end
        monkeypatch.setattr(summary, "MOST_STEPS", most)
        summing = Summing()
        for start in range(0, len(log), 50):
            rows = slice(start, start + 50)
            summing.take(replace(log, time=log.time[rows], value=log.value[rows], fresh=log.fresh[rows]))
        assert (summing.rows, summing.end_s) == (len(log), log.time[-1])
        np.testing.assert_allclose(summing.pauses, [pause])
        for mine, theirs in zip(summing.sensors, whole, strict=True):
            assert (mine.name, mine.channels, mine.units) == (theirs.name, theirs.channels, theirs.units)
            assert astuple(mine)[3:] == pytest.approx(astuple(theirs)[3:], rel=1e-9)


@pytest.mark.parametrize("name", [name for name, recipe in METHODS.items() if not recipe.parts])
def test_what_keeps_a_method_from_running_is_what_its_fit_says(name: str) -> None:
    rig = fitted.rig().between(end_s=10.0)
    bare: Log = rig.select([channel.path for channel in rig.channels if channel.sensor == "gyro"][:1])
    silent = Log(bare.time, bare.value * 0, bare.fresh, bare.channels, bare.sensors)
    for log in (bare, silent):
        reason = METHODS[name].lacks(log)
        if reason:
            with pytest.raises(LogError) as error:
                METHODS[name].build(log, 0, Session())
            assert str(error.value) == reason
    assert METHODS[name].lacks(silent)  # a still gyro alone is nothing to any of them


def test_a_method_of_parts_runs_if_one_of_them_does() -> None:
    rig = fitted.rig().between(end_s=20.0)
    car = METHODS["car-composite"]
    assert car.lacks(rig) == ""
    assert set(car.lacking_parts(rig)) < {part.name for part in car.parts}
    still = Log(rig.time, rig.value * 0, rig.fresh, rig.channels, rig.sensors)
    assert car.lacks(still)


def test_info_of_what_is_not_there(run: Run) -> None:
    said = run("info", "nowhere.mcap")
    assert (said.code, said.out) == (2, "")
    assert len(said.err.splitlines()) == 1


def test_info_of_a_recording(run: Run, tmp_path: Path) -> None:
    mcap(tmp_path / "drive.mcap")
    said = run("info", "drive.mcap")
    assert said.code == 0, said.err
    assert "topics of unknown type left out: /image" in said.err


def test_a_reason_is_said_once_for_all_methods_that_it_holds_against(run: Run, tmp_path: Path) -> None:
    mcap(tmp_path / "drive.mcap")
    result = run("info", "drive.mcap", "--json", "info.json")
    reasons = list(json.loads((tmp_path / "info.json").read_text())["does_not_apply"].values())
    assert len(set(reasons)) < len(reasons)
    for reason in set(reasons):
        assert result.out.count(f"no: {reason[:60]}") == len({one for one in reasons if one[:60] == reason[:60]})
