"""MATLAB structures as a log, and each bad one as one sentence."""

from pathlib import Path

import numpy as np
import pytest
from scipy.io import savemat

from sensorfault.logs import LogError, VehicleFile, guess, read

RANDOM = np.random.default_rng(4)
TIME = 0.02 * np.arange(400)
FLIGHT = {"time": TIME, "ax": RANDOM.normal(0, 1, 400), "ay": RANDOM.normal(0, 1, 400), "az": 9.8 + 0 * TIME}
FLIGHT["az"] = FLIGHT["az"] + RANDOM.normal(0, 0.1, 400)


def test_a_structure_is_a_table(tmp_path: Path) -> None:
    path = tmp_path / "flight.mat"
    savemat(path, {"data": {**FLIGHT, "motor": np.arange(7.0), "who": "thor", "rate": 50.0}})
    log = read(path)
    assert [channel.path for channel in log.channels] == ["accelerometer.x", "accelerometer.y", "accelerometer.z"]
    np.testing.assert_array_equal(log.value[:, 0], FLIGHT["ax"])
    assert any("1 vector of another length than 400 left out: motor" in note for note in log.notes)


def test_vectors_in_no_structure_are_one_too(tmp_path: Path) -> None:
    path = tmp_path / "flight.mat"
    savemat(path, FLIGHT)
    np.testing.assert_array_equal(read(path).value[:, 1], FLIGHT["ay"])


def test_of_two_structures_each_is_named(tmp_path: Path) -> None:
    path = tmp_path / "flight.mat"
    slow = {"time": TIME[::10], "alt": 100 + RANDOM.normal(0, 1, 40)}
    savemat(path, {"imu": FLIGHT, "gps": slow})
    vehicle = guess(path)
    assert VehicleFile.parse(vehicle.to_toml()) == vehicle
    assert {file.table for file in vehicle.files} == {"imu", "gps"}
    log = read(path, vehicle)
    fresh = log.fresh[:, log.index("height.altitude")]
    np.testing.assert_array_equal(log.value[fresh, log.index("height.altitude")], slow["alt"])
    other = tmp_path / "next.mat"
    savemat(other, {"imu": FLIGHT, "gps": slow})
    assert len(read(other, vehicle)) == 400  # one description serves many flights
    nameless = VehicleFile.parse('[file.log]\ntime = "time"\n[sensor.s.channel]\na = { column = "ax" }\n')
    with pytest.raises(LogError, match=r"several tables; write table = .* imu, gps"):
        read(path, nameless)
    wrong = VehicleFile.parse('[file.log]\ntable = "x"\ntime = "time"\n[sensor.s.channel]\na = { column = "ax" }\n')
    with pytest.raises(LogError, match="no table 'x' in it"):
        read(path, wrong)


@pytest.mark.parametrize("content", [b"", b"no MATLAB at all, but long " * 20, b"\x89HDF\r\n\x1a\n" + bytes(600)])
def test_what_is_no_matlab_file(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "flight.mat"
    path.write_bytes(content)
    with pytest.raises(LogError, match=r"not a whole MATLAB file \(.*\); save it again"):
        read(path)


def test_a_file_that_breaks_off(tmp_path: Path) -> None:
    path = tmp_path / "flight.mat"
    savemat(path, {"data": FLIGHT})
    path.write_bytes(path.read_bytes()[:5000])
    with pytest.raises(LogError, match="not a whole MATLAB file"):
        read(path)


def test_the_newest_version_is_named(tmp_path: Path) -> None:
    path = tmp_path / "flight.mat"
    header = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM"
    path.write_bytes(header + bytes(600))
    with pytest.raises(LogError, match=r"version 7\.3; save it again"):
        read(path)


@pytest.mark.parametrize("content", [{"name": "thor"}, {"a": 1.0}, {"data": {"x": np.zeros((3, 3))}}])
def test_nothing_to_read(tmp_path: Path, content: dict[str, object]) -> None:
    path = tmp_path / "flight.mat"
    savemat(path, content)
    with pytest.raises(LogError, match="no vectors of numbers"):
        read(path)
