"""A model keeps what the columns of its log were read as, and other logs are read in the same way."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import fitted
from cli.conftest import write_csv
from logs import written_dataflash
from sensorfault.logs import Log, LogError, read
from sensorfault.methods.fit import fit
from sensorfault.runtime.detect import Live, detect
from sensorfault.runtime.model import Model
from sensorfault.runtime.store import load, save
from sensorfault.runtime.streaming import detect_file

RIG = "car.csv"


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Model:
    """Of 60 s of the rig, whose table is in deg/s, as a guess finds out."""
    path = write_csv(tmp_path_factory.mktemp("described") / RIG, fitted.rig().between(end_s=60.0))
    return fit(read(path), "relative-conditioning", held_out=0.0)


def calm(folder: Path, name: str = "calm.csv", empty: str = "", frozen: str = "") -> Path:
    """A part of the rig that turns so slowly that its gyro might be in rad/s."""
    rig = fitted.rig().between(120.0, 140.0)
    value = rig.value.copy()
    value[:, :3] *= 0.05
    for path, number in ((empty, np.nan), (frozen, 0.01)):
        if path:
            value[:, rig.index(path)] = number
    return write_csv(folder / name, replace(rig, value=value))


def test_the_unit_is_not_guessed_again(model: Model, tmp_path: Path) -> None:
    log = read(calm(tmp_path), model=model.description)
    np.testing.assert_allclose(log.value[:, :3], 0.05 * fitted.rig().between(120.0, 140.0).value[:, :3], atol=1e-7)
    assert detect(model, log).events == ()


def test_a_log_that_was_read_in_another_unit_is_refused(model: Model, tmp_path: Path) -> None:
    with pytest.raises(
        LogError, match=r"by a guess the column 'gyro_x' is gyro.x \[rad/s\], by the model it is gyro.x \[deg"
    ):
        detect(model, read(calm(tmp_path)))


@pytest.mark.parametrize("whole", [True, False])
@pytest.mark.parametrize(("what", "kind"), [("empty", "missing"), ("frozen", "frozen")])
def test_a_sensor_without_a_change_is_its_own_fault(
    model: Model, tmp_path: Path, what: str, kind: str, whole: bool
) -> None:
    path = calm(tmp_path, **{what: "gyro.x"})
    found = detect(model, read(path, model=model.description)) if whole else detect_file(model, path)
    assert [(event.sensor, event.channel, event.kind) for event in found.events] == [("gyro", "x", kind)]
    assert found.events[0].end_s is None


def test_it_is_in_the_model_file(model: Model, tmp_path: Path) -> None:
    save(model, tmp_path / "car.sensorfault")
    again = load(tmp_path / "car.sensorfault").description
    assert again == model.description
    assert again is not None
    assert again.guessed
    assert (again.epoch_s, again.zero_s) == (None, None)
    assert next((s.name, s.held, s.period_s) for s in again.sensors) == ("gyro", False, pytest.approx(0.02))
    assert again.files[0].path == RIG


def test_a_model_without_it_loads_and_judges(model: Model, tmp_path: Path) -> None:
    summary = {key: value for key, value in model.summary.items() if not key.startswith("description")}
    save(replace(model, summary=summary), tmp_path / "old.sensorfault")
    old = load(tmp_path / "old.sensorfault")
    assert old.description is None
    log = read(write_csv(tmp_path / RIG, fitted.rig().between(60.0, 80.0)))
    assert detect(old, log).events == ()
    with pytest.raises(LogError, match="does not know the columns of its log"):
        old.sample({"gyro_x": 1.0})


def test_live_takes_the_columns_of_the_log_in_their_units(model: Model) -> None:
    names = [*(f"gyro_{a}" for a in "xyz"), *(f"acc_{a}" for a in "xyz"), "east_m", "north_m"]
    rig = fitted.rig().between(120.0, 122.0)
    row = dict(zip(names, [*np.degrees(rig.value[0, :3]), *rig.value[0, 3:]], strict=True))
    np.testing.assert_allclose(model.sample(row), rig.value[0], rtol=1e-12)
    row.pop("gyro_y")
    assert np.isnan(model.sample(row | {"other": 1.0})[1])
    with pytest.raises(LogError, match=r"none of the columns speed is one that the model knows; give gyro_x, gyro_y"):
        model.sample({"speed": 1.0})
    assert Live(model).push(0.0, model.sample(row)).channel.shape == (8,)


@cache
def flight(seconds: float, gps: bool) -> bytes:
    """An autopilot's log, with a receiver or without one."""
    said, kinds = written_dataflash.flight(seconds=seconds), written_dataflash.KINDS
    if gps:
        return said
    head = b"\xa3\x95" + bytes([kinds["GPS"][0]])
    length = len(written_dataflash.message("GPS", 3, 0, 0, 0, *[0.0] * 7, 0))
    while (at := said.find(head)) >= 0:
        said = said[:at] + said[at + length :]
    return said


def test_a_sensor_that_has_no_table_is_missing(tmp_path: Path) -> None:
    (tmp_path / "healthy.bin").write_bytes(flight(40.0, gps=True))
    (tmp_path / "without.bin").write_bytes(flight(20.0, gps=False))
    made = fit(read(tmp_path / "healthy.bin"), "relative-conditioning", held_out=0.0)
    log: Log = read(tmp_path / "without.bin", model=made.description)
    assert any("There is no GPS in this log, so gnss has no values." in note for note in log.notes)
    assert ("gnss", None, "missing") in [(e.sensor, e.channel, e.kind) for e in detect(made, log).events]
