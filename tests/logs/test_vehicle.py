import re
import shutil
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import fitted
from sensorfault.logs import Log, LogError, VehicleFile, read, write
from sensorfault.logs import vehicle as vehicle_module
from sensorfault.logs.entries import ChannelEntry, FileEntry, SensorEntry
from sensorfault.logs.parts import read_parts
from sensorfault.logs.table import KINDS, SAID
from sensorfault.logs.units import UNITS

GOOD = """
[vehicle]
name = "car"
[file.log]
time = "t"
unit = "ms"
[sensor.gyro.channel]
x = { column = "wx", unit = "deg/s" }
"""

names = st.text(st.characters(exclude_categories=("Cs", "Cc")), min_size=1, max_size=8)
keys = names.filter(lambda name: "." not in name)
reasons = st.text(st.characters(exclude_categories=("Cs", "Cc", "Zl", "Zp")), max_size=8)
finite = st.floats(allow_nan=False, allow_infinity=False)
channels = st.builds(
    ChannelEntry,
    keys,
    names,
    st.sampled_from(sorted(UNITS)),
    st.none() | finite,
    st.none() | names,
    st.booleans(),
    st.none() | st.just("fix_type >= 2"),
    st.sampled_from(KINDS),
    reasons,
).map(lambda one: replace(one, watch=False) if one.kind in SAID else one)


@st.composite
def vehicles(draw: st.DrawFn) -> VehicleFile:
    files = draw(
        st.lists(
            st.builds(
                FileEntry, keys, st.none() | names, st.none() | names, st.sampled_from(["s", "ms", "iso8601"]), finite
            ),
            min_size=1,
            max_size=3,
            unique_by=lambda file: file.name,
        )
    )
    sensor = st.builds(
        SensorEntry,
        keys,
        st.lists(channels, min_size=1, max_size=3, unique_by=lambda channel: channel.name).map(tuple),
        st.sampled_from([file.name for file in files]),
        st.booleans(),
        st.none() | names,
        st.none() | finite,
        why=reasons,
    )
    sensors = draw(st.lists(sensor, min_size=1, max_size=3, unique_by=lambda sensor: sensor.name))
    zero = st.none() | finite
    size = st.none() | st.floats(1e-3, 1e3)
    numbers = [draw(zero), draw(zero), draw(size), draw(size)]
    return VehicleFile(draw(names), tuple(files), tuple(sensors), *numbers, notes=tuple(draw(st.lists(reasons))))


@settings(max_examples=100, deadline=None)
@given(vehicles())
def test_what_is_written_parses_to_the_same(vehicle: VehicleFile) -> None:
    assert VehicleFile.parse(vehicle.to_toml()) == vehicle


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("[vehicle]", "[vehicle", "this is not TOML .*; correct that line"),
        ('name = "car"', 'nmae = "car"', r"\[vehicle\] has an unknown key 'nmae'; take one of name"),
        (
            "[vehicle]",
            "[vehikel]\n[vehicle]",
            "the top has an unknown key 'vehikel'; take one of vehicle, file, sensor",
        ),
        ('unit = "ms"', 'unit = "eon"', r"\[file.log\] unit = 'eon' is no unit of time; take one of s, ms"),
        ('unit = "deg/s"', 'unit = "furlong"', r"\[sensor.gyro.channel.x\] unit = 'furlong' is unknown; take one of"),
        ('time = "t"', "time = 7", r"\[file.log\] time = 7 must be a text in quotes"),
        ('time = "t"', 'tiem = "t"', r"\[file.log\] has an unknown key 'tiem'"),
        ('column = "wx", ', "", r"\[sensor.gyro.channel.x\] names no column"),
        ('x = { column = "wx", unit = "deg/s" }', "", r"\[sensor.gyro.channel\] is empty"),
        ('{ column = "wx", unit = "deg/s" }', '"wx"', r"'sensor.gyro.channel.x' must be a table"),
        (
            "[sensor.gyro.channel]",
            '[sensor.gyro]\nfile = "imu"\n[sensor.gyro.channel]',
            "file = 'imu' is not described",
        ),
        ("[sensor.gyro.channel]", "[file.other]\n[sensor.gyro.channel]", "does not say which file it is in"),
        ("[sensor.gyro.channel]", "[sensor.gyro]\nheld = 1\n[sensor.gyro.channel]", "held = 1 must be true or false"),
        ("[sensor.gyro.channel]", '[sensor."gy.ro".channel]', "the sensor name 'gy.ro' has a dot"),
    ],
)
def test_errors_name_table_key_and_mend(old: str, new: str, sentence: str) -> None:
    assert old in GOOD
    with pytest.raises(LogError, match=sentence) as raised:
        VehicleFile.parse(GOOD.replace(old, new), "car/vehicle.toml")
    assert str(raised.value).startswith("car/vehicle.toml: ")
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize("table", ["file", "sensor"])
def test_a_table_that_is_missing(table: str) -> None:
    kept = "\n".join(
        line for line in GOOD.splitlines() if not line.startswith(("t", "u", "x")) and f"[{table}" not in line
    )
    with pytest.raises(LogError, match=rf"no \[{table}.NAME\] table"):
        VehicleFile.parse(kept)


def test_a_vehicle_file_that_is_not_there(tmp_path: Path) -> None:
    with pytest.raises(LogError, match="cannot read this vehicle file"):
        VehicleFile.read(tmp_path / "vehicle.toml")


def test_which_vehicle_file_is_taken(tmp_path: Path) -> None:
    for name in ("drive.csv", "other.csv"):
        (tmp_path / name).write_text("t,wx\n" + "".join(f"{20 * k},{k % 9}.5\n" for k in range(50)))
    named = read(tmp_path / "drive.csv", VehicleFile.parse(GOOD.replace("car", "given")))
    assert named.name == "given"
    assert read(tmp_path / "drive.csv").name == "drive"  # guessed
    (tmp_path / "vehicle.toml").write_text(GOOD.replace("car", "beside"))
    assert read(tmp_path / "drive.csv").name == "beside"
    (tmp_path / "vehicle.toml").write_text(GOOD.replace("car", "beside").replace("time", 'path = "other.csv"\ntime'))
    assert read(tmp_path / "other.csv").name == "beside"
    assert read(tmp_path / "drive.csv").name == "drive"  # that one describes another file
    assert read(tmp_path).name == "beside"
    (tmp_path / "drive.vehicle.toml").write_text(GOOD.replace("car", "own"))
    assert read(tmp_path / "drive.csv").name == "own"
    other = read(tmp_path / "drive.csv", tmp_path / "vehicle.toml")
    assert (other.name, other.notes) == (
        "drive",
        read(tmp_path / "other.csv").notes,
    )  # it does well, but is not called so
    assert any("guess" in note for note in read(tmp_path / "other.csv", None).notes) is False


def test_a_described_file_that_is_missing(tmp_path: Path) -> None:
    (tmp_path / "a.csv").write_text("t,wx\n0,1\n1,2\n")
    (tmp_path / "b.csv").write_text("t,wx\n0,1\n1,2\n")
    vehicle = VehicleFile.parse(GOOD.replace("time", 'path = "c.csv"\ntime'))
    with pytest.raises(LogError, match=r"path = 'c.csv' is not among a.csv, b.csv"):
        read(tmp_path, vehicle)


def test_the_description_of_the_format_is_of_the_format() -> None:
    example = (vehicle_module.__doc__ or "").split("\n\n", 1)[1]
    vehicle = VehicleFile.parse(example)
    assert VehicleFile.parse(vehicle.to_toml()) == vehicle
    assert vehicle.sensors[0].channels[3].epoch == "far_time"
    assert [channel.watch for channel in vehicle.sensors[0].channels] == [True, False, True, True, True, False]
    assert vehicle.sensors[0].channels[4].valid == "fix_type >= 2"
    assert vehicle.sensors[0].channels[5].kind == "quality"


def test_a_sensor_says_watch_for_all_of_its_channels() -> None:
    text = GOOD.replace("[sensor.gyro.channel]", "[sensor.gyro]\nwatch = false\n[sensor.gyro.channel]")
    text += 'y = { column = "wy" }\nz = { column = "wz", watch = true }\n'
    vehicle = VehicleFile.parse(text)
    assert [channel.watch for channel in vehicle.sensors[0].channels] == [False, False, True]
    assert vehicle.to_toml().count("watch = false }") == 2
    none = VehicleFile.parse(text.replace("watch = true", "watch = false"))
    assert none.to_toml().count("watch") == 1
    assert VehicleFile.parse(none.to_toml()) == none


def test_a_log_that_another_logs_file_describes_has_its_own_name(tmp_path: Path) -> None:
    rig = fitted.rig().between(end_s=5.0)
    vehicle = write(replace(rig, name="rig"), tmp_path / "first.csv")
    shutil.copy(tmp_path / "first.csv", tmp_path / "second.csv")
    assert read(tmp_path / "first.csv").name == "rig"
    assert read(tmp_path / "second.csv", vehicle).name == "second"
    parts: list[Log] = []
    read_parts(tmp_path / "second.csv", parts.append, vehicle)
    assert parts[0].name == "second"


VALID = GOOD + 'y = { column = "wy", valid = "fix >= 2" }\nfix = { column = "fix", kind = "quality" }\n'


def test_no_value_where_its_condition_does_not_hold(tmp_path: Path) -> None:
    vehicle = VehicleFile.parse(VALID)
    assert VehicleFile.parse(vehicle.to_toml()) == vehicle
    rows = "".join(f"{100 * t},{t},{t + 0.5},{'' if t == 5 else t % 4}\n" for t in range(20))
    (tmp_path / "log.csv").write_text(f"t,wx,wy,fix\n{rows}")
    log = read(tmp_path / "log.csv", vehicle)
    there = np.array([t % 4 >= 2 and t != 5 for t in range(20)])
    np.testing.assert_array_equal(np.isfinite(log.value[:, log.index("gyro.y")]), there)
    np.testing.assert_array_equal(log.fresh[:, log.index("gyro.y")], there)
    assert np.isfinite(log.value[:, log.index("gyro.x")]).all()
    assert log.fresh[:, log.index("gyro.fix")].sum() == 19
    again = read(tmp_path / "copy.csv", write(log, tmp_path / "copy.csv"))
    assert again.channels == log.channels
    assert [channel.path for channel in log.measurements().channels] == ["gyro.x", "gyro.y"]


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ('valid = "fix"', "valid = 'fix' is no condition; write one like 'fix_type >= 2'"),
        ('valid = "fix >= two"', "is no condition"),
        ('kind = "state"', "kind = 'state' is unknown; take one of estimate, quality, context"),
    ],
)
def test_a_wrong_condition_or_kind_is_refused(wrong: str, said: str) -> None:
    with pytest.raises(LogError, match=re.escape(said)):
        VehicleFile.parse(GOOD + f'y = {{ column = "wy", {wrong} }}\n')
