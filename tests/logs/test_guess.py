"""A guess is right on logs whose makers and units differ, and parses back to itself."""

from pathlib import Path

import numpy as np
import polars as pl
import pytest

from sensorfault.logs import LogError, VehicleFile, guess, read
from sensorfault.logs.guess.words import read_name
from sensorfault.vehicles.underwater import roles

ROWS = 4000
TIME = np.arange(ROWS) * 0.02
RANDOM = np.random.default_rng(11)
TURN = 0.3 * np.sin(TIME / 7)  # [rad/s]
SPEED = 12 + 5 * np.sin(TIME / 11)  # [m/s]
HEADING = np.cumsum(TURN) * 0.02 + 3
NORTH, EAST = np.cumsum(SPEED * np.cos(HEADING)) * 0.02, np.cumsum(SPEED * np.sin(HEADING)) * 0.02
LATITUDE, LONGITUDE = 51 + np.degrees(NORTH / 6.371e6), 13.7 + np.degrees(EAST / 6.371e6 / np.cos(np.radians(51)))
ACC = RANDOM.normal(size=(ROWS, 3)) * 0.3 + [0.2, -0.1, 9.81]
GYRO = RANDOM.normal(size=(ROWS, 3)) * 0.02 + np.column_stack([0 * TURN, 0 * TURN, TURN])
FIX = np.arange(ROWS) // 5 * 5  # the row of the last fix: 10 Hz on 50 Hz


def save(folder: Path, table: dict[str, np.ndarray], name: str = "drive.csv") -> Path:
    path = folder / name
    frame = pl.DataFrame(table)
    if path.suffix == ".parquet":
        frame.write_parquet(path)
    else:
        frame.write_csv(path, include_header=not name.startswith("bare"))
    return path


def described(vehicle: VehicleFile) -> dict[str, dict[str, tuple[str, str]]]:
    return {s.name: {c.name: (c.column, c.unit) for c in s.channels} for s in vehicle.sensors}


def blind(vehicle: VehicleFile) -> set[str]:
    """Channels that are not watched; each says why."""
    unwatched = [(s, c) for s in vehicle.sensors for c in s.channels if not c.watch]
    assert all("only dropouts are detected" in c.why for _, c in unwatched)
    return {f"{s.name}.{c.name}" for s, c in unwatched}


def round_trip(vehicle: VehicleFile) -> None:
    text = vehicle.to_toml()
    assert VehicleFile.parse(text) == vehicle
    assert text.count("#") > len(vehicle.sensors)


@pytest.mark.parametrize("name", ["drive.csv", "drive.parquet"])
@pytest.mark.parametrize(
    ("acc", "acc_unit", "gyro", "gyro_unit", "speed", "speed_unit"),
    [
        (1.0, "m/s^2", 1.0, "rad/s", 1.0, "m/s"),
        (1 / 9.80665, "g", 180 / np.pi, "deg/s", 3.6, "km/h"),
        (1000 / 9.80665, "mg", 180 / np.pi, "deg/s", 3600 / 1852, "kn"),
    ],
)
def test_a_car_log(
    tmp_path: Path, name: str, acc: float, acc_unit: str, gyro: float, gyro_unit: str, speed: float, speed_unit: str
) -> None:
    table = {
        "millis": np.round(1.4e12 + TIME * 1e3, 3),
        "ax": ACC[:, 0] * acc, "ay": ACC[:, 1] * acc, "az": ACC[:, 2] * acc,
        "rollrate": GYRO[:, 0] * gyro, "pitchrate": GYRO[:, 1] * gyro, "yawrate": GYRO[:, 2] * gyro,
        "speed": (SPEED * speed)[FIX], "course": (np.degrees(HEADING) % 360)[FIX],
        "latitude": LATITUDE[FIX], "longitude": LONGITUDE[FIX], "altitude": (120 + RANDOM.normal(size=ROWS))[FIX],
        "hdop": np.round(RANDOM.uniform(1, 2, ROWS), 1), "fix": np.full(ROWS, 3),
        "utc": 123825300 + FIX * 20,
    }  # fmt: skip
    vehicle = guess(save(tmp_path, table, name))
    assert (vehicle.files[0].time, vehicle.files[0].unit) == ("millis", "ms")
    assert described(vehicle) == {
        "accelerometer": {axis: (f"a{axis}", acc_unit) for axis in "xyz"},
        "gyro": {"x": ("rollrate", gyro_unit), "y": ("pitchrate", gyro_unit), "z": ("yawrate", gyro_unit)},
        "gnss": {
            "speed": ("speed", speed_unit),
            "course": ("course", "deg"),
            "latitude": ("latitude", "deg"),
            "longitude": ("longitude", "deg"),
            "altitude": ("altitude", "m"),
        },
    }
    assert {s.name for s in vehicle.sensors if s.held} == {"gnss"}
    assert blind(vehicle) == {"gnss.course", "gnss.latitude", "gnss.longitude", "gnss.altitude"}
    assert {s.epoch for s in vehicle.sensors if s.held} == {"utc"}
    assert {column for column, _ in vehicle.files[0].left_out} == {"hdop", "fix", "utc"}
    round_trip(vehicle)
    log = read(tmp_path / name)
    assert log.fresh[:, log.index("speed")].sum() == ROWS // 5
    np.testing.assert_allclose(log.value[:, log.index("gyro.z")], GYRO[:, 2], rtol=1e-9)
    np.testing.assert_allclose(log.value[:, log.index("speed")], SPEED[FIX], rtol=1e-9)


def receiver(speed: np.ndarray, course: np.ndarray, altitude: np.ndarray, epoch: bool) -> dict[str, np.ndarray]:
    """10 Hz on rows of 50 Hz; each argument says, for each row, from which row that output is."""
    height = np.round(120 + RANDOM.normal(size=ROWS), 3)
    table = {
        "t": TIME, "speed": SPEED[speed], "course": (np.degrees(HEADING) % 360)[course],
        "latitude": LATITUDE[FIX], "longitude": LONGITUDE[FIX], "altitude": height[altitude],
    }  # fmt: skip
    return table | ({"utc": 123825300 + FIX * 20} if epoch else {})


LATER, LATEST = (np.maximum(np.arange(ROWS) - k, 0) // 5 * 5 for k in (1, 2))  # the same fix, said a row or two later
SECONDLY = np.arange(ROWS) // 50 * 50


@pytest.mark.parametrize("epoch", [True, False])
def test_a_receiver_that_says_all_at_once_is_one_sensor(tmp_path: Path, epoch: bool) -> None:
    path = save(tmp_path, receiver(FIX, FIX, FIX, epoch))
    assert list(described(guess(path))) == ["gnss"]
    log = read(path)
    np.testing.assert_array_equal(log.fresh, np.repeat((np.arange(ROWS) % 5 == 0)[:, None], 5, axis=1))


def test_outputs_in_phases_are_one_sensor_only_with_an_epoch(tmp_path: Path) -> None:
    path = save(tmp_path, receiver(LATER, LATER, LATEST, epoch=True))
    assert {s.name: s.epoch for s in guess(path).sensors} == {"gnss": "utc"}
    assert read(path).sensors[0].period_s == pytest.approx(0.1)
    path = save(tmp_path, receiver(LATER, LATER, LATEST, epoch=False))
    assert set(described(guess(path))) == {"gnss_speed", "gnss_course", "gnss", "gnss_height"}
    log = read(path)
    assert [s.period_s for s in log.sensors] == pytest.approx([0.1] * 4)
    assert abs(log.fresh.sum(axis=0) - ROWS // 5).max() <= 1


@pytest.mark.parametrize("epoch", [True, False])
def test_a_slow_output_is_a_sensor_of_its_own(tmp_path: Path, epoch: bool) -> None:
    path = save(tmp_path, receiver(SECONDLY, FIX, FIX, epoch))
    assert set(described(guess(path))) == {"gnss_speed", "gnss"}
    log = read(path)
    assert {s.name: round(s.period_s, 3) for s in log.sensors} == {"gnss_speed": 1.0, "gnss": 0.1}
    assert log.fresh[:, log.index("speed")].sum() == ROWS // 50


@pytest.mark.parametrize("epoch", [True, False])
def test_a_coarse_output_stays_with_its_receiver(tmp_path: Path, epoch: bool) -> None:
    table = receiver(FIX, FIX, FIX, epoch)
    table["altitude"] = np.round(120 + 3 * np.sin(TIME / 3))[FIX]  # the same for many fixes, never for as many
    path = save(tmp_path, table)
    assert list(described(guess(path))) == ["gnss"]
    log = read(path)
    assert log.fresh[:, log.index("altitude")].sum() == ROWS // 5


def test_a_heading_that_comes_with_each_row_is_not_the_receivers(tmp_path: Path) -> None:
    path = save(tmp_path, receiver(FIX, np.arange(ROWS), FIX, epoch=True))
    assert set(described(guess(path))) == {"gnss", "gnss_course"}
    assert {s.name: s.held for s in read(path).sensors} == {"gnss": True, "gnss_course": False}


@pytest.mark.parametrize(("gravity", "unit"), [(1.0, "g"), (9.80665, "m/s^2")])
@pytest.mark.parametrize("gyro_first", [False, True])
def test_a_file_without_names(tmp_path: Path, gravity: float, unit: str, gyro_first: bool) -> None:
    acc, gyro = ACC / 9.80665 * gravity, np.degrees(GYRO)
    order = np.column_stack([gyro, acc] if gyro_first else [acc, gyro])
    table = {f"a{i}": column for i, column in enumerate(order.T)} | {"t": 261906 + np.round(TIME * 1e3).astype(int)}
    vehicle = guess(save(tmp_path, table, "bare.csv"))
    assert (vehicle.files[0].time, vehicle.files[0].unit) == ("c7", "ms")
    first, second = ("gyro", "accelerometer") if gyro_first else ("accelerometer", "gyro")
    units = {"accelerometer": unit, "gyro": "deg/s"}
    assert described(vehicle) == {
        first: {axis: (f"c{i + 1}", units[first]) for i, axis in enumerate("xyz")},
        second: {axis: (f"c{i + 4}", units[second]) for i, axis in enumerate("xyz")},
    }
    round_trip(vehicle)


def test_sensors_that_are_silent_for_a_while(tmp_path: Path) -> None:
    """Once: rows without any value gave a warning of NumPy's instead of a unit."""
    gyro, acc = np.degrees(GYRO), ACC.copy()
    gyro[500:700] = np.nan
    acc[::2, 0], acc[1::2, 1:] = np.nan, np.nan  # no row has all three
    table = {"time_s": TIME, **dict(zip(("gyro_x", "gyro_y", "gyro_z"), gyro.T, strict=True))}
    table |= dict(zip(("acc_x", "acc_y", "acc_z"), acc.T, strict=True))
    units = {name: {unit for _, unit in c.values()} for name, c in described(guess(save(tmp_path, table))).items()}
    assert units["gyro"] == {"deg/s"}
    assert units["accelerometer"] == {"m/s^2"}


def test_three_columns_of_about_one_are_no_accelerometer_unless_their_length_is_steady(tmp_path: Path) -> None:
    noise = RANDOM.normal(size=(ROWS, 3)) * 0.65
    table = {f"a{i}": column for i, column in enumerate(noise.T)} | {"t": TIME}
    assert "accelerometer" not in described(guess(save(tmp_path, table, "bare.csv")))


def test_files_of_one_drive_keep_their_sensors_apart(tmp_path: Path) -> None:
    stamp = (1_734_501_485_000_000_000 + np.round(TIME * 1e9)).astype(np.int64)
    for anchor in (3, 5):
        save(tmp_path, {"stamp": stamp + anchor, "distance": RANDOM.uniform(3, 9, ROWS)}, f"run_1_A{anchor}.csv")
    (tmp_path / "notes.txt").write_text("it rained\n")
    vehicle = guess(tmp_path)
    assert described(vehicle) == {f"a{k}_range": {"range": ("distance", "m")} for k in (3, 5)}
    assert [file.unit for file in vehicle.files] == ["ns", "ns"]
    assert any("notes.txt" in note for note in vehicle.notes)
    round_trip(vehicle)
    assert len(read(tmp_path)) == ROWS


def test_two_drives_in_a_folder_are_refused(tmp_path: Path) -> None:
    for run in (1, 2):
        save(tmp_path, {"Time [s]": TIME, "V North [m/s]": RANDOM.normal(size=ROWS)}, f"run{run}.csv")
    with pytest.raises(LogError, match=r"run1.csv and run2.csv have the same columns .* name the files of one drive"):
        guess(tmp_path)


def test_minus_one_among_ranges_is_no_value(tmp_path: Path) -> None:
    ranges = np.where(RANDOM.random(ROWS) < 0.3, -1.0, RANDOM.uniform(5, 50, ROWS))
    path = save(tmp_path, {"timestamp": 1.7e9 + TIME, "distance_r0": ranges})
    assert guess(path).sensors[0].channels[0].missing == -1
    log = read(path)
    np.testing.assert_array_equal(np.isnan(log.value[:, 0]), ranges == -1)


@pytest.mark.parametrize(
    ("scale", "digits", "unit"), [(1.0, 3, "s"), (1e3, 0, "ms"), (1e6, 0, "us")], ids=["s", "ms", "us"]
)
def test_the_unit_of_a_counter_by_its_interval(tmp_path: Path, scale: float, digits: int, unit: str) -> None:
    path = save(tmp_path, {"timestamp": np.round((327 + TIME) * scale, digits), "ax": ACC[:, 0]})
    assert guess(path).files[0].unit == unit
    assert read(path).period_s == pytest.approx(0.02)


def test_roll_and_pitch_are_watched_unless_they_wrap(tmp_path: Path) -> None:
    table = {
        "t": TIME,
        "roll": RANDOM.normal(size=ROWS) * 0.1,
        "pitch": (RANDOM.normal(size=ROWS) * 3) % 360,
        "yaw": HEADING,
    }
    vehicle = guess(save(tmp_path, table))
    assert list(described(vehicle)) == ["attitude"]
    assert blind(vehicle) == {"attitude.pitch", "attitude.yaw"}


def test_unknown_names_are_kept_and_what_wanders_is_not_watched(tmp_path: Path) -> None:
    table = {
        "t": TIME,
        "flux": RANDOM.normal(size=ROWS),
        "charge": 100 - TIME + RANDOM.normal(size=ROWS),
        "gear": RANDOM.integers(1, 6, ROWS),
        "odometer": np.floor(TIME * 100),
        "same": np.full(ROWS, 2.5),
    }
    vehicle = guess(save(tmp_path, table))
    assert set(described(vehicle)) == {"flux", "charge"}
    assert blind(vehicle) == {"charge.charge"}
    assert {column for column, _ in vehicle.files[0].left_out} == {"gear", "odometer", "same"}


@pytest.mark.parametrize(
    ("column", "kind", "axis", "unit"),
    [
        ("ax", "accelerometer", "x", ""),
        ("accel_z", "accelerometer", "z", ""),
        ("IMU::UncompAccel::X [m/s^2]", "accelerometer", "x", "m/s^2"),
        ("linear_acceleration.y", "accelerometer", "y", ""),
        ("IMU::AngularRate::X", "gyro", "x", ""),
        ("angular_velocity.z", "gyro", "z", ""),
        ("yaw_rate_deg_s", "gyro", "z", "deg/s"),
        ("rollspeed", "gyro", "x", ""),
        ("IMU::UncompMag::X [Gauss]", "magnetometer", "x", "gauss"),
        ("latitude(deg)", "position", "latitude", "deg"),
        ("Longitude [rad]", "position", "longitude", "rad"),
        ("V North [m/s]", "velocity", "north", "m/s"),
        ("vn(m/s)", "velocity", "north", "m/s"),
        ("vel_d_m_s", "velocity", "down", "m/s"),
        ("DVL X [m/s]", "velocity", "x", "m/s"),
        ("indicated_airspeed_m_s", "airspeed", "indicated_airspeed", "m/s"),
        ("cog_rad", "heading", "course", "rad"),
        ("field.distanceFromTag", "range", "range", ""),
        ("distance_r2", "range", "r2", ""),
        ("q[3]", "quaternion", "3", ""),
        ("pressure_hpa", "barometer", "pressure", "hPa"),
        ("sdn(m)", "quality", "sdn", "m"),
        ("satellites_used", "quality", "satellites_used", ""),
        ("Time::TimeStartup [ns]", "time", "time_time_startup", "ns"),
        ("control[1]", "", "control_1", ""),
        ("DesRoll", "quality", "des_roll", ""),
        ("ax_bias", "quality", "ax_bias", ""),
        ("BarAlt", "height", "altitude", ""),
        ("Spd", "speed", "speed", ""),
        ("GCrs", "heading", "course", ""),
        ("theta", "attitude", "pitch", ""),
        ("psi", "heading", "yaw", ""),
        ("pitch_of_quaternion [rad]", "attitude", "pitch", "rad"),
        ("yaw_of_quaternion [rad]", "heading", "yaw", "rad"),
    ],
)
def test_names(column: str, kind: str, axis: str, unit: str) -> None:
    meaning = read_name(column)
    assert (meaning.kind, meaning.axis, meaning.unit) == (kind, axis, unit)


def test_a_leader_is_one_sensor_even_if_it_lies_still(tmp_path: Path) -> None:
    path, random = tmp_path / "dive.csv", np.random.default_rng(0)
    rows = ["time_s,leader1_range,leader1_latitude,leader1_longitude,leader2_range,leader2_latitude,leader2_longitude"]
    for k in range(200):
        r = random.normal(100, 1, 2)
        rows.append(f"{k},{r[0]:.2f},48.1,11.5,{r[1]:.2f},{48.2 + 1e-5 * k:.6f},{11.6 - 1e-5 * k:.6f}")
    path.write_text("\n".join(rows))
    found = {sensor.name: [channel.name for channel in sensor.channels] for sensor in guess(path).sensors}
    assert found == {"leader1": ["range", "latitude", "longitude"], "leader2": ["range", "latitude", "longitude"]}
    assert len(roles(read(path)).leaders) == 2


def test_how_sure_a_unit_is(tmp_path: Path) -> None:
    table = {
        "t": TIME, "gyro_x [rad/s]": GYRO[:, 0], "rollrate": 3000 * GYRO[:, 2], "speed": SPEED, "pressure": 1e3 + SPEED,
        **{f"acc_{axis}": ACC[:, i] for i, axis in enumerate("xyz")},
    }  # fmt: skip
    vehicle = guess(save(tmp_path, table))
    sure = {f"{s.name}.{c.name}": c.why.partition(":")[0] for s in vehicle.sensors for c in s.channels}
    assert {"gyro.x": "sure", "accelerometer.z": "likely", "speed.speed": "a guess"}.items() <= sure.items()
    assert {why for path, why in sure.items() if "pressure" in path} == {"a guess"}
    assert {why for path, why in sure.items() if "rollrate" in path} == {"likely"}


def test_a_sensor_that_never_changes_is_one_all_the_same(tmp_path: Path) -> None:
    table = {
        "t": TIME, "gyro_x": np.full(ROWS, 0.25), "gyro_y": GYRO[:, 1], "gyro_z": GYRO[:, 2], "mag_x": 0.0 * TIME,
        "speed": SPEED, "limit": 7.5 + 0.0 * TIME, "pressure": np.where(TIME[9] == TIME, 1000.0, np.nan),
    }  # fmt: skip
    vehicle = guess(save(tmp_path, table))
    assert set(described(vehicle)["gyro"]) == {"x", "y", "z"}
    assert set(described(vehicle)["magnetometer"]) == {"x"}
    assert vehicle.files[0].left_out == (("limit", "constant"), ("pressure", "holds one value"))
