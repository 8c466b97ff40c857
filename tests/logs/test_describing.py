"""Which description of its columns a log is read with: a vehicle.toml, what a model knows, or a guess."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from sensorfault.logs import Log, LogError, VehicleFile, read
from sensorfault.logs.agreement import conflict
from sensorfault.logs.parts import read_parts

VEHICLE = """
[vehicle]
name = "car"
[file.log]
path = "first.csv"
time = "t"
unit = "ms"
[sensor.gyro.channel]
x = { column = "wx", unit = "deg/s" }
y = { column = "wy", unit = "deg/s" }
[sensor.wheel]
held = true
[sensor.wheel.channel]
speed = { column = "v", unit = "km/h", missing = -1 }
"""
MODEL = replace(VehicleFile.parse(VEHICLE), where="the model car.sensorfault")


def put(path: Path, header: str = "t,wx,wy,v", rows: int = 50, wx: str = "") -> Path:
    lines = [f"{20 * k},{wx or np.sin(k)},{np.cos(k)},{k // 5}" for k in range(rows)]
    path.write_text("\n".join([header, *lines]) + "\n")
    return path


def in_parts(path: Path, model: VehicleFile | None = None) -> tuple[Log, tuple[str, ...]]:
    parts: list[Log] = []
    said = read_parts(path, parts.append, model=model)
    return parts[0], said.notes


@pytest.mark.parametrize("whole", [True, False])
def test_a_vehicle_file_beside_is_used_whatever_name_stands_in_it(tmp_path: Path, whole: bool) -> None:
    (tmp_path / "vehicle.toml").write_text(VEHICLE)
    path = put(tmp_path / "second.csv")
    log = read(path) if whole else in_parts(path)[0]
    notes = log.notes if whole else in_parts(path)[1]
    assert log.name == "second"
    np.testing.assert_allclose(log.value[:, 0], np.radians(np.sin(np.arange(50))))
    assert not any("guess" in note or "not used" in note for note in notes)


@pytest.mark.parametrize("whole", [True, False])
def test_one_that_does_not_fit_is_not_used_and_it_is_said_why(tmp_path: Path, whole: bool) -> None:
    (tmp_path / "vehicle.toml").write_text(VEHICLE)
    path = put(tmp_path / "second.csv", "t,gyro_x,gyro_y,v")
    notes = read(path).notes if whole else in_parts(path)[1]
    assert f"{tmp_path / 'vehicle.toml'} is of another log and was not used: second.csv has no column 'wx'." in notes
    assert any(note.startswith("No vehicle.toml: ") for note in notes)


def test_one_that_names_the_log_must_fit(tmp_path: Path) -> None:
    (tmp_path / "vehicle.toml").write_text(VEHICLE)
    with pytest.raises(LogError, match="there is no column 'wx'"):
        read(put(tmp_path / "first.csv", "t,gyro_x,gyro_y,v"))


@pytest.mark.parametrize("whole", [True, False])
def test_what_a_model_knows_is_not_guessed(tmp_path: Path, whole: bool) -> None:
    path = put(tmp_path / "other.csv", wx="0.5")
    log = read(path, model=MODEL) if whole else in_parts(path, MODEL)[0]
    notes = log.notes if whole else in_parts(path, MODEL)[1]
    assert [channel.path for channel in log.channels] == ["gyro.x", "gyro.y", "wheel.speed"]
    np.testing.assert_allclose(log.value[:, 0], np.radians(0.5))
    assert log.fresh[:, 2].sum() == 10
    assert log.name == "other"
    assert "Columns are read as the model car.sensorfault knows them." in notes
    assert any("by a guess" in note for note in read(path, model=replace(MODEL, guessed=True)).notes)


def test_a_log_with_some_of_the_columns_is_refused_and_one_of_another_kind_guessed(tmp_path: Path) -> None:
    with pytest.raises(LogError, match=r"some.csv has no column 'wx', which the model car.sensorfault knows"):
        read(put(tmp_path / "some.csv", "t,gyro_x,wy,v"), model=MODEL)
    other = read(put(tmp_path / "else.csv", "millis,gyro_x,gyro_y,speed"), model=MODEL)
    assert any(note.startswith("No vehicle.toml: ") for note in other.notes)


def test_the_user_may_describe_another_recorder(tmp_path: Path) -> None:
    path = put(tmp_path / "some.csv", "t,rate,wy,v")
    mine = VehicleFile.parse(VEHICLE.replace('column = "wx", unit = "deg/s"', 'column = "rate", unit = "rad/s"'))
    np.testing.assert_allclose(read(path, mine, model=MODEL).value[:, 0], np.sin(np.arange(50)))


def test_of_a_vehicle_file_without_a_channel_of_the_model_the_time_stays(tmp_path: Path) -> None:
    """As `init` writes one for a log in which a column is empty."""
    text = VEHICLE.replace('x = { column = "wx", unit = "deg/s" }\n', "").replace(
        "[file.log]", "epoch_s = 5.0\n[file.log]"
    )
    (tmp_path / "vehicle.toml").write_text(text.replace("first.csv", "other.csv"))
    known = replace(MODEL, sensors=tuple(replace(sensor, period_s=0.02) for sensor in MODEL.sensors))
    log = read(put(tmp_path / "other.csv", wx=" "), model=known)
    assert log.epoch_s == 5.0
    assert np.isnan(log.value[:, log.index("gyro.x")]).all()


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        (
            '"wx", unit = "deg/s"',
            '"wx", unit = "rad/s"',
            r"by mine.toml the column 'wx' is gyro.x \[rad/s\], by the model",
        ),
        ('x = { column = "wx"', 'z = { column = "wx"', r"the column 'wx' is gyro.z \[deg/s\], by the model .* gyro.x"),
        (
            "held = true",
            "held = false",
            r"'v' is wheel.speed \[km/h\] new in each row, by .* wheel.speed \[km/h\] held",
        ),
        ("missing = -1", "missing = 0", r"missing = 0, by the model car.sensorfault it is .* missing = -1"),
        ('unit = "ms"', 'unit = "s"', "the time column 't' is in s, by the model car.sensorfault in ms"),
    ],
)
def test_two_that_disagree(tmp_path: Path, old: str, new: str, sentence: str) -> None:
    assert VEHICLE.count(old) == 1
    mine = VehicleFile.parse(VEHICLE.replace(old, new), "mine.toml")
    with pytest.raises(LogError, match=sentence):
        read(put(tmp_path / "log.csv"), mine, model=MODEL)
    (tmp_path / "vehicle.toml").write_text(VEHICLE.replace(old, new))
    with pytest.raises(LogError, match="correct one of them, or fit the model again"):
        read(put(tmp_path / "log.csv"), model=MODEL)


def test_what_only_one_describes_is_no_disagreement() -> None:
    more = VehicleFile.parse(VEHICLE + 'more = { column = "m" }\n')
    assert conflict(more, MODEL) == conflict(MODEL, more) == ""
    assert conflict(VehicleFile.parse(VEHICLE.replace(", missing = -1", "")), MODEL) == ""


def test_files_of_one_log_are_not_mixed_up() -> None:
    text = """
    [file.one]
    path = "one.csv"
    time = "t"
    [file.two]
    path = "two.csv"
    time = "t"
    unit = "ms"
    [sensor.gyro]
    file = "one"
    [sensor.gyro.channel]
    x = { column = "x", unit = "rad/s" }
    [sensor.accelerometer]
    file = "two"
    [sensor.accelerometer.channel]
    x = { column = "x", unit = "g" }
    """
    assert conflict(VehicleFile.parse(text), VehicleFile.parse(text)) == ""


def test_a_time_tag_is_that_of_the_file(tmp_path: Path) -> None:
    from sensorfault.logs.place import pair_files

    vehicle = VehicleFile.parse(VEHICLE.replace('unit = "ms"', 'unit = "ms"\ntag = "first.csv.tag"'))
    ((entry, _),) = pair_files(vehicle, put(tmp_path / "first.csv"))
    assert entry.tag == "first.csv.tag"
    ((entry, _),) = pair_files(vehicle, put(tmp_path / "second.csv"))
    assert entry.tag is None
    (tmp_path / "second.csv.tag").write_text("")
    ((entry, _),) = pair_files(vehicle, tmp_path / "second.csv")
    assert entry.tag == "second.csv.tag"
