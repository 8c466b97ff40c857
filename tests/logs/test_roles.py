"""What columns are by their names, their neighbours' and their file's; and files that lie in folders."""

import gzip
import zipfile
from pathlib import Path

import can
import numpy as np
import polars as pl
import pytest
from scipy.io import savemat

from logs import written_bus
from sensorfault.logs import Log, LogError, read
from sensorfault.logs.readers import gzipped
from sensorfault.logs.units import spelled, to_si

N = 200
TIME = 0.1 * np.arange(N)
RANDOM = np.random.default_rng(3)


def noise(size: float = 1.0) -> np.ndarray:
    return RANDOM.normal(0, size, N)


def table(path: Path, **columns: np.ndarray) -> Path:
    pl.DataFrame({"time": TIME, **columns}).write_csv(path)
    return path


def kinds(log: Log) -> dict[str, str]:
    return {channel.path: channel.unit for channel in log.channels}


@pytest.mark.parametrize(
    ("written", "unit"),
    [
        ("feet", "ft"), ("Degrees", "deg"), ("mph", "mph"), ("m s^-1", "m/s"), ("rad s^-1", "rad/s"),
        ("m·s⁻²", "m/s^2"), ("m/s2", "m/s^2"), ("meters per second squared", "m/s^2"), ("deg/sec", "deg/s"),
        ("Knots", "kn"), ("miles/h", "mph"), ("KM/H", "km/h"), ("kPa", "kPa"), ("μT", "uT"), ("m/s/s", "m/s^2"),
        ("furlong", "furlong"),
    ],
)  # fmt: skip
def test_units_in_words_and_powers(written: str, unit: str) -> None:
    assert spelled(written) == unit


def test_units_are_what_they_are_called() -> None:
    assert to_si(1.0, "mph") == pytest.approx(0.44704)
    assert to_si(1.0, "feet per minute") == pytest.approx(0.00508)
    assert to_si(180.0, "degrees") == pytest.approx(np.pi)


def test_g_is_gravity_on_an_accelerometer_and_a_field_on_a_compass(tmp_path: Path) -> None:
    acc = {"accelerationX(G)": noise(0.01), "accelerationY(G)": noise(0.01), "accelerationZ(G)": 1 + noise(0.01)}
    mag = {f"mag{axis}(G)": 0.3 + noise(0.01) for axis in "XYZ"}
    log = read(table(tmp_path / "log.csv", **acc, **mag))
    assert log.value[:, log.index("accelerometer.z")].mean() == pytest.approx(9.8, abs=0.1)
    assert log.value[:, log.index("magnetometer.x")].mean() == pytest.approx(0.3e-4, rel=0.1)


def test_raw_counts_have_no_unit(tmp_path: Path) -> None:
    counts = {f"a{axis}": np.round(noise(200)) for axis in "xy"} | {"az": np.round(16384 + noise(200))}
    turns = {f"g{axis}": np.round(noise(300)) for axis in "xyz"}
    log = read(table(tmp_path / "log.csv", **counts, **turns))
    assert kinds(log) == {f"{sensor}.{axis}": "" for sensor in ("accelerometer", "gyro") for axis in "xyz"}


@pytest.mark.parametrize(("name", "sensor"), [("Gyroscope.csv", "gyro"), ("TotalAcceleration.csv", "accelerometer")])
def test_a_file_says_what_its_x_y_z_are(tmp_path: Path, name: str, sensor: str) -> None:
    log = read(table(tmp_path / name, z=9.8 + noise(0.1), y=noise(0.1), x=noise(0.1)))
    assert {channel.sensor for channel in log.channels} == {sensor}


def trajectory() -> np.ndarray:
    turn = 0.05 * TIME
    return np.column_stack(
        [TIME, np.cos(TIME), np.sin(TIME), 1 + 0 * TIME, 0 * turn, 0 * turn, np.sin(turn), np.cos(turn)]
    )


@pytest.mark.parametrize("header", ["", "# timestamp tx ty tz qx qy qz qw\n"])
def test_a_trajectory_is_places_and_a_quaternion(tmp_path: Path, header: str) -> None:
    path = tmp_path / "pose.txt"
    path.write_text(header + "\n".join(" ".join(f"{x:.6f}" for x in row) for row in trajectory()) + "\n")
    log = read(path)
    assert {c.sensor for c in log.channels} == {"local_position", "quaternion"}
    assert kinds(log)["local_position.x"] == "m"


def test_a_planar_pose_has_a_heading_and_a_turn_rate(tmp_path: Path) -> None:
    log = read(
        table(
            tmp_path / "pose.csv",
            x=TIME,
            y=noise(),
            theta=0.1 * TIME,
            linear_velocity=1 + noise(0.1),
            angular_velocity=noise(0.1),
        )
    )
    assert kinds(log) | {"speed.speed": "m/s"} == {
        "local_position.x": "m", "local_position.y": "m", "heading.heading": "rad", "speed.speed": "m/s",
        "gyro.z": "rad/s",
    }  # fmt: skip


def test_the_angles_of_an_attitude_have_one_unit(tmp_path: Path) -> None:
    angles = {"roll": 2 + noise(1.0), "pitch": noise(1.0), "yaw": 100 + noise(1.0)}
    log = read(table(tmp_path / "log.csv", **angles))
    assert kinds(log) == {f"attitude.{name}": "deg" for name in angles}
    place = {"latitude": 52 + 1e-5 * TIME, "longitude": 13 + 1e-5 * TIME, "altitude": 700 + noise(1.0)}
    log = read(table(tmp_path / "gnss.csv", **place, course=1 + noise(0.1)))
    assert kinds(log)["gnss.course"] == "rad"  # what else its receiver says are no angles


def test_a_receiver_without_a_position_is_one_all_the_same(tmp_path: Path) -> None:
    log = read(table(tmp_path / "log.csv", gnss_speed=10 + noise(0.1), gnss_course=100 + noise(1.0)))
    assert [sensor.name for sensor in log.sensors] == ["gnss"]
    log = read(table(tmp_path / "other.csv", gps_heading=100 + noise(1.0), gps_speed=10 + noise(0.1)))
    assert "gnss.course" in kinds(log)


def test_w_x_y_z_are_a_quaternion(tmp_path: Path) -> None:
    pose = trajectory()
    log = read(table(tmp_path / "log.csv", W=pose[:, 7], X=pose[:, 4], Y=pose[:, 5], Z=pose[:, 6]))
    assert {c.sensor for c in log.channels} == {"quaternion"}


def euroc(folder: Path, *devices: str) -> Path:
    for device in devices:
        path = folder / "mav0" / device / "data.csv"
        path.parent.mkdir(parents=True)
        head = "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
        head += "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n"
        rows = np.column_stack([noise(0.1), noise(0.1), noise(0.1), noise(0.1), noise(0.1), 9.8 + noise(0.1)])
        stamps = 1_400_000_000_000_000_000 + (TIME * 1e9).astype(int)
        path.write_text(
            head
            + "".join(f"{t}," + ",".join(f"{x:.5f}" for x in row) + "\n" for t, row in zip(stamps, rows, strict=True))
        )
    return folder


def test_the_folders_of_a_drive(tmp_path: Path) -> None:
    one = read(euroc(tmp_path / "easy", "imu0"))
    assert one.name == "easy"
    assert [sensor.name for sensor in one.sensors] == ["gyro", "accelerometer"]
    two = read(euroc(tmp_path / "hard", "imu0", "imu1"))
    assert [sensor.name for sensor in two.sensors] == [
        "imu0_gyro",
        "imu0_accelerometer",
        "imu1_gyro",
        "imu1_accelerometer",
    ]
    with pytest.raises(LogError, match="its folders easy, hard hold logs; name one of them"):
        read(tmp_path)


def kitti(folder: Path, rows: int = N) -> Path:
    (folder / "oxts" / "data").mkdir(parents=True)
    stamps = "".join(f"2011-09-26 13:02:{20 + t:012.9f}\n" for t in TIME[:rows])
    (folder / "oxts" / "timestamps.txt").write_text(stamps)
    for i in range(rows):
        numbers = [49 + 1e-5 * i, 8.4, 110.0, *RANDOM.normal(0, 0.1, 20), 0.05, 0.02, 4, 8, 5, 5, 6]
        (folder / "oxts" / "data" / f"{i:010d}.txt").write_text(" ".join(map(str, numbers)))
    return folder


def test_kitti(tmp_path: Path) -> None:
    log = read(kitti(tmp_path / "drive"))
    assert [sensor.name for sensor in log.sensors] == ["gnss", "attitude", "accelerometer", "gyro"]
    assert log.time[-1] == pytest.approx(TIME[-1])
    assert log.value[10, log.index("gnss.latitude")] == pytest.approx(np.radians(49.0001))
    next((tmp_path / "drive" / "oxts" / "data").iterdir()).unlink()
    with pytest.raises(LogError, match="200 times, but 199 files"):
        read(tmp_path / "drive")


def test_comma2k19_as_it_comes(tmp_path: Path) -> None:
    for name, value in (
        ("CAN/wheel_speed", np.tile(10 + noise(0.1), (4, 1)).T),
        ("IMU/gyro", RANDOM.normal(0, 0.1, (N, 3))),
    ):
        folder = tmp_path / "drive" / "processed_log" / name
        folder.mkdir(parents=True)
        for file, array in (("t", 100 + TIME), ("value", value)):
            with (folder / file).open("wb") as opened:
                np.save(opened, array)
    log = read(tmp_path / "drive")
    assert {sensor.name for sensor in log.sensors} == {"wheels", "gyro"}
    assert log.name == "drive"


def test_one_file_in_a_zip(tmp_path: Path) -> None:
    file = table(tmp_path / "flight.csv", ax=noise(), ay=noise(), az=9.8 + noise(0.1))
    for name, files in (("one.zip", ["flight.csv"]), ("two.zip", ["flight.csv", "other.csv"])):
        with zipfile.ZipFile(tmp_path / name, "w", zipfile.ZIP_DEFLATED) as packed:
            for inside in files:
                packed.write(file, inside)
    np.testing.assert_array_equal(read(tmp_path / "one.zip").value, read(file).value)
    with pytest.raises(LogError, match="archive of several files"):
        read(tmp_path / "two.zip")
    (tmp_path / "odd.zip").write_bytes((tmp_path / "one.zip").read_bytes()[:200])
    with pytest.raises(LogError, match="this zip is damaged, or none; pack the log again"):
        read(tmp_path / "odd.zip")


@pytest.mark.parametrize("suffix", [".gz", ".zip"])
def test_no_more_is_unpacked_than_may_be(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, suffix: str) -> None:
    file = table(tmp_path / "flight.csv", ax=noise(), ay=noise(), az=9.8 + noise(0.1))
    packed = tmp_path / f"flight.csv{suffix}"
    if suffix == ".gz":
        packed.write_bytes(gzip.compress(file.read_bytes()))
    else:
        with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
            archive.write(file, "flight.csv")
    monkeypatch.setattr(gzipped, "most", gzipped.Most(5000))
    with pytest.raises(LogError, match=r"larger than 5e-06 GB.* allow more with --max-size"):
        read(packed)
    monkeypatch.setattr(gzipped, "most", gzipped.Most())
    assert gzipped.most.bytes > 10**8
    assert len(read(packed)) == N


def test_matrices_in_a_mat_file(tmp_path: Path) -> None:
    savemat(
        tmp_path / "log.mat",
        {"time": TIME[:, None], "Gyroscope": RANDOM.normal(0, 0.1, (N, 3)), "q": trajectory()[:, 4:]},
    )
    log = read(tmp_path / "log.mat")
    assert {"gyro.x", "gyro.y", "gyro.z"} <= set(kinds(log))


def test_tables_of_mission_planner(tmp_path: Path) -> None:
    imu = np.column_stack([np.arange(N), TIME * 1e6, RANDOM.normal(0, 0.1, (N, 5)), noise(0.1) - 9.8])
    labels = np.array(["LineNo", "TimeUS", "GyrX", "GyrY", "GyrZ", "AccX", "AccY", "AccZ"], object)
    savemat(tmp_path / "flight.mat", {"IMU": imu, "IMU_label": labels[:, None]})
    log = read(tmp_path / "flight.mat")
    assert [sensor.name for sensor in log.sensors] == ["gyro", "accelerometer"]
    assert log.time[-1] == pytest.approx(TIME[-1])


def test_frames_in_an_mdf_file(tmp_path: Path) -> None:
    path = written_bus.framed(tmp_path / "drive.mf4")
    log = read(path)
    assert {"front_left", "front_right"} <= {channel.name for channel in log.channels}
    (tmp_path / "alone").mkdir()
    with pytest.raises(LogError, match=r"no \.dbc file beside it"):
        read(path.rename(tmp_path / "alone" / "drive.mf4"))


def test_candump_and_trc(tmp_path: Path) -> None:
    written_bus.asc(tmp_path / "drive.asc")
    for name, writer in (("drive.log", can.CanutilsLogWriter), ("drive.trc", can.TRCWriter)):
        with writer(tmp_path / name) as file:
            for frame in written_bus.frames():
                file.on_message_received(frame)
        log = read(tmp_path / name)
        assert log.value[0, log.index("front_left")] == pytest.approx(10.0)


def test_a_truck_is_read_by_its_groups(tmp_path: Path) -> None:
    path = written_bus.truck(tmp_path / "truck.blf")
    log = read(path)
    assert log.value[5, 0] == pytest.approx(2 * np.pi / 60 * 800)


def test_a_log_that_is_none_of_all(tmp_path: Path) -> None:
    (tmp_path / "a.log").write_text("hello\nworld\n")
    with pytest.raises(LogError, match="none of a flight"):
        read(tmp_path / "a.log")


def test_quantities_of_messages_are_no_devices(tmp_path: Path) -> None:
    columns = {f"{name}.{axis}": noise(0.1) for name in ("AngularVelocity", "orientation") for axis in "xyz"}
    columns |= {f"linear_acceleration.{axis}": noise(0.1) + 9.8 * (axis == "z") for axis in "xyz"}
    log = read(table(tmp_path / "imu.csv", **columns))
    assert {sensor.name for sensor in log.sensors} == {"gyro", "attitude", "accelerometer"}
    columns |= {"orientation.w": 1 + noise(0.01)}
    assert "quaternion" in {sensor.name for sensor in read(table(tmp_path / "with_w.csv", **columns)).sensors}


def test_a_fix_without_names(tmp_path: Path) -> None:
    path = tmp_path / "gps.csv"
    rows = np.column_stack([TIME, 51.98 + 1e-6 * np.arange(N), 5.66 + 2e-6 * np.arange(N), 174_035 + noise()])
    path.write_text("".join(",".join(f"{x:.9f}" for x in row) + "\n" for row in rows))
    assert {"latitude", "longitude"} <= {channel.name for channel in read(path).channels}


def test_a_folder_of_very_many_files_is_no_drive(tmp_path: Path) -> None:
    for i in range(2001):
        (tmp_path / f"{i}.csv").touch()
    with pytest.raises(LogError, match="2,001 of its files may be logs"):
        read(tmp_path)
