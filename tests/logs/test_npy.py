"""NumPy arrays as a log: what pairs with what, and each bad input as one sentence."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sensorfault.logs import LogError, VehicleFile, guess, read

RANDOM = np.random.default_rng(3)
TIME = 100.0 + 0.01 * np.arange(400)
GYRO = RANDOM.normal(0, 0.1, (400, 3))


def put(folder: Path, **arrays: np.ndarray) -> Path:
    folder.mkdir(exist_ok=True)
    for name, array in arrays.items():
        np.save(folder / f"{name}.npy", array)
    return folder


def test_a_folder_of_arrays_is_one_log_on_the_fastest_clock(tmp_path: Path) -> None:
    speed = RANDOM.uniform(5, 9, (80, 1))
    folder = put(
        tmp_path / "drive", IMU__gyro__t=TIME, IMU__gyro__value=GYRO, CAN__speed__t=TIME[::5], CAN__speed__value=speed
    )
    log = read(folder)
    assert [channel.path for channel in log.channels] == ["gyro.x", "gyro.y", "gyro.z", "speed.speed"]
    np.testing.assert_allclose(log.time, TIME - TIME[0], atol=1e-9)
    np.testing.assert_array_equal(log.value[:, :3], GYRO)
    np.testing.assert_array_equal(np.flatnonzero(log.fresh[:, 3]), np.arange(0, 400, 5))
    np.testing.assert_array_equal(log.value[::5, 3], speed[:, 0])
    assert np.isnan(log.value[1, 3])
    assert log.epoch_s is None


def test_the_description_reads_the_same_log(tmp_path: Path) -> None:
    folder = put(tmp_path / "drive", gyro__t=TIME, gyro__value=GYRO, speed_t=TIME[::5], speed_value=GYRO[::5, 0])
    described = VehicleFile.parse(guess(folder).to_toml())
    guessed, known = read(folder), read(folder, described)
    np.testing.assert_array_equal(guessed.value, known.value)
    assert guessed.channels == known.channels


@pytest.mark.parametrize(
    ("time", "value"),
    [("gyro__t", "gyro__value"), ("gyro_t", "gyro_value"), ("gyro.t", "gyro.value"), ("gyro.t", "gyro")],
)
@pytest.mark.parametrize("named", ["time", "value", "folder"])
def test_ways_to_name_a_pair(tmp_path: Path, time: str, value: str, named: str) -> None:
    folder = put(tmp_path / "drive", **{time: TIME, value: GYRO})
    log = read({"time": folder / f"{time}.npy", "value": folder / f"{value}.npy", "folder": folder}[named])
    np.testing.assert_array_equal(log.value, GYRO)
    assert [channel.path for channel in log.channels] == ["gyro.x", "gyro.y", "gyro.z"]


def test_one_clock_for_several_arrays(tmp_path: Path) -> None:
    folder = put(tmp_path / "d", car_frame_times=TIME, car_frame_velocities=GYRO, car_frame_gauge=GYRO[:, :2])
    log = read(folder)
    assert [channel.name for channel in log.channels] == ["gauge_c1", "gauge_c2", "x", "y", "z"]
    np.testing.assert_array_equal(log.value, np.column_stack([GYRO[:, :2], GYRO]))


def test_columns_nobody_documents_are_numbered(tmp_path: Path) -> None:
    folder = put(tmp_path / "d", thing__t=TIME, thing__value=GYRO, other__t=TIME, other__value=GYRO + 1.0)
    assert [channel.column for sensor in guess(folder).sensors for channel in sensor.channels] == ["c1", "c2", "c3"] * 2


def test_nanoseconds_since_1970_lose_nothing(tmp_path: Path) -> None:
    stamps = 1_533_226_000_000_000_123 + 10_000_001 * np.arange(400)
    log = read(put(tmp_path / "d", gyro__t=stamps, gyro__value=GYRO.astype(">f4")))
    np.testing.assert_allclose(log.time, 10_000_001e-9 * np.arange(400), atol=1e-12)
    np.testing.assert_array_equal(log.value, GYRO.astype(np.float32))
    assert log.epoch_s == pytest.approx(1_533_226_000.0)


def test_raw_readings_do_not_vouch_for_their_own_sensor(tmp_path: Path) -> None:
    folder = put(
        tmp_path / "d", gyro__t=TIME, gyro__value=GYRO, gyro_uncalibrated__t=TIME, gyro_uncalibrated__value=GYRO + 0.1
    )
    log = read(folder)
    assert [sensor.name for sensor in log.sensors] == ["gyro"]
    assert any("gyro_uncalibrated__t.npy: left out" in note for note in log.notes)


def test_of_two_receivers_the_faster_comes_first(tmp_path: Path) -> None:
    way = np.column_stack([51 + TIME * 1e-5, 13 + TIME * 1e-5, 5 + GYRO[:, 0], TIME, 90 + GYRO[:, 1], 45 + GYRO[:, 2]])
    arrays = {
        "b__gyro__t": TIME,
        "b__gyro__value": GYRO,
        "a__live_gnss_qcom__t": TIME[::40],
        "a__live_gnss_qcom__value": way[::40],
        "a__live_gnss_ublox__t": TIME[::5],
        "a__live_gnss_ublox__value": way[::5],
    }
    log = read(put(tmp_path / "d", **arrays))
    assert [sensor.name for sensor in log.sensors] == ["gyro", "live_gnss_ublox", "live_gnss_qcom"]
    names = [channel.name for channel in log.channels if channel.sensor == "live_gnss_ublox"]
    assert names == ["latitude", "longitude", "speed", "altitude", "course"]


def test_steering_and_wheels(tmp_path: Path) -> None:
    wheels = RANDOM.uniform(5, 9, (400, 4))
    folder = put(
        tmp_path / "d",
        steering_angle__t=TIME,
        steering_angle__value=GYRO[:, 0],
        wheel_speed__t=TIME,
        wheel_speed__value=wheels,
    )
    log = read(folder)
    np.testing.assert_allclose(log.value[:, log.index("steering.angle")], np.radians(GYRO[:, 0]), rtol=1e-12)
    np.testing.assert_array_equal(log.value[:, log.index("wheels.rear_left")], wheels[:, 2])


def one_sentence(message: str) -> bool:
    return "\n" not in message and message.endswith((".", ")")) and "Traceback" not in message and len(message) < 600


def alone(folder: Path) -> Path:
    put(folder, gyro__value=GYRO)
    return folder / "gyro__value.npy"


def without_values(folder: Path) -> Path:
    put(folder, gyro__t=TIME)
    return folder / "gyro__t.npy"


def truncated(folder: Path) -> Path:
    put(folder, gyro__t=TIME, gyro__value=GYRO)
    path = folder / "gyro__value.npy"
    path.write_bytes(path.read_bytes()[:-100])
    return path


def truncated_header(folder: Path) -> Path:
    put(folder, gyro__t=TIME, gyro__value=GYRO)
    path = folder / "gyro__value.npy"
    path.write_bytes(path.read_bytes()[:40])
    return path


def no_bytes(folder: Path) -> Path:
    put(folder, gyro__t=TIME)
    (folder / "gyro__value.npy").write_bytes(b"")
    return folder / "gyro__value.npy"


def no_array(folder: Path) -> Path:
    put(folder, gyro__t=TIME)
    (folder / "gyro__value.npy").write_text("time,gyro\n1,2\n")
    return folder / "gyro__value.npy"


def an_archive(folder: Path) -> Path:
    put(folder, gyro__t=TIME)
    with (folder / "gyro__value.npy").open("wb") as file:
        np.savez(file, GYRO)
    return folder / "gyro__value.npy"


def objects(folder: Path) -> Path:
    put(folder, gyro__t=TIME, gyro__value=np.array([{}] * 400, object))
    return folder / "gyro__value.npy"


def words(folder: Path) -> Path:
    put(folder, gyro__t=TIME, gyro__value=np.array(["a"] * 400))
    return folder / "gyro__value.npy"


def complex_numbers(folder: Path) -> Path:
    put(folder, gyro__t=TIME, gyro__value=GYRO + 1j)
    return folder / "gyro__value.npy"


def one_number(folder: Path) -> Path:
    put(folder, gyro__t=TIME, gyro__value=np.array(3.0))
    return folder / "gyro__value.npy"


def nothing(folder: Path) -> Path:
    put(folder, gyro__t=TIME[:0], gyro__value=GYRO[:0])
    return folder / "gyro__t.npy"


def cube(folder: Path) -> Path:
    put(folder, gyro__t=TIME, gyro__value=np.zeros((400, 3, 3)))
    return folder / "gyro__value.npy"


def two_columns_of_time(folder: Path) -> Path:
    put(folder, gyro__t=np.column_stack([TIME, TIME]), gyro__value=GYRO)
    return folder / "gyro__t.npy"


def other_length(folder: Path) -> Path:
    put(folder, gyro__t=TIME, gyro__value=GYRO[:-1])
    return folder / "gyro__value.npy"


def one_row(folder: Path) -> Path:
    put(folder, gyro__t=TIME[:1], gyro__value=GYRO[:1])
    return folder / "gyro__t.npy"


def out_of_order(folder: Path) -> Path:
    put(folder, gyro__t=RANDOM.permutation(TIME), gyro__value=GYRO)
    return folder / "gyro__t.npy"


def backwards(folder: Path) -> Path:
    put(folder, gyro__t=TIME[::-1], gyro__value=GYRO)
    return folder / "gyro__t.npy"


def timeless(folder: Path) -> Path:
    put(folder, gyro__t=np.full(400, np.nan), gyro__value=GYRO)
    return folder / "gyro__t.npy"


CASES: list[tuple[Callable[[Path], Path], str, str]] = [
    (alone, "there are no times beside these values", r"save them as gyro__t\.npy, in seconds"),
    (without_values, "there are no values beside these times", r"save them as gyro__value\.npy"),
    (truncated, "not a whole array", "save it again"),
    (truncated_header, "not a whole array", "save it again"),
    (no_bytes, "not a whole array", "save it again"),
    (no_array, "not a whole array", "save it again"),
    (an_archive, "not a whole array", "save it again"),
    (objects, "not a whole array of numbers .*Python objects", "save it again"),
    (words, "not a table of numbers", "save one"),
    (complex_numbers, "not a table of numbers", "save one"),
    (one_number, "not a table of numbers", "save one"),
    (nothing, "not a table of numbers", "save one"),
    (cube, "an array of 3 axes is not a table", "save rows"),
    (two_columns_of_time, r"times of shape \(400, 2\)", "one time a row"),
    (other_length, r"399 rows, but gyro__t\.npy has 400", "one row for each time"),
    (one_row, "one row is no log", "at least two rows"),
    (out_of_order, "goes back", "sort the file"),
    (backwards, "goes back 399 times", "sort the file"),
    (timeless, "no|empty", "row|time"),
]


@pytest.mark.parametrize(("make", "wrong", "mend"), CASES, ids=[case[0].__name__ for case in CASES])
def test_bad_arrays_are_one_sentence(tmp_path: Path, make: Callable[[Path], Path], wrong: str, mend: str) -> None:
    path = make(tmp_path / "drive")
    for way in (path, path.parent):
        for call in (read, guess):
            with pytest.raises(LogError, match=wrong) as raised:
                call(way)
            assert one_sentence(str(raised.value))
            assert str(path) in str(raised.value)
            with pytest.raises(LogError, match=mend):
                call(way)


def test_a_pickle_is_never_opened(tmp_path: Path) -> None:
    class Trap:
        def __reduce__(self) -> tuple[Callable[[str], None], tuple[str]]:
            return pytest.fail, ("unpickled",)

    folder = put(tmp_path / "drive", gyro__t=TIME)
    np.save(folder / "gyro__value.npy", np.array([Trap()] * 400, object), allow_pickle=True)
    with pytest.raises(LogError, match="not a whole array"):
        read(folder)


def test_one_bad_pair_of_several_is_left_out_and_said(tmp_path: Path) -> None:
    folder = put(tmp_path / "d", gyro__t=TIME, gyro__value=GYRO, bad__t=TIME, bad__value=GYRO[:-1], lost__value=GYRO)
    log = read(folder)
    assert [sensor.name for sensor in log.sensors] == ["gyro"]
    assert sum("Left out: " in note for note in log.notes) == 2
