"""MATLAB structures as a log, and each bad one as one sentence."""

import sys
from pathlib import Path

import h5py
import numpy as np
import pytest
from polars.testing import assert_frame_equal
from scipy.io import savemat

from logs import written_mat73
from sensorfault.logs import LogError, VehicleFile, guess, read
from sensorfault.logs.readers.formats import read_tables

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


EVERYTHING = {
    "data": {**{name: one[:, None] for name, one in FLIGHT.items()}, "on": FLIGHT["ax"][:, None] > 0, "who": "thor"},
    "alone": FLIGHT["ay"][:, None].astype(np.float32),
    "counted": np.arange(400, dtype=np.int32)[None, :],
    "nothing": np.empty((0, 0)),
    "picture": np.ones((30, 40)),
    "rate": np.array([[50.0]]),
}


@pytest.mark.parametrize("packed", [True, False])
def test_version_7_3_holds_the_same_tables(tmp_path: Path, packed: bool) -> None:
    savemat(tmp_path / "old.mat", EVERYTHING)
    old = read_tables(tmp_path / "old.mat")
    new = read_tables(written_mat73.save(tmp_path / "new.mat", EVERYTHING, packed))
    assert new.keys() == old.keys() == {"data", "variables"}
    for name in old:
        assert_frame_equal(new[name].frame, old[name].frame, check_column_order=False)


def test_damage_to_one_vector_of_version_7_3_costs_that_one(tmp_path: Path) -> None:
    path = written_mat73.save(tmp_path / "flight.mat", {"data": {name: one[:, None] for name, one in FLIGHT.items()}})
    with h5py.File(path) as file:
        at, size = file["data/ay"].id.get_chunk_info(0)[2:]
    content = bytearray(path.read_bytes())
    content[512 + at + size // 2] ^= 255
    path.write_bytes(content)
    log = read(path)
    assert [channel.path for channel in log.channels] == ["accelerometer.x", "accelerometer.z"]
    (said,) = log.damage
    assert said.startswith("flight.mat: a vector cannot be read (")
    assert said.endswith("at 'data.ay'; the others were read.")
    path.write_bytes(content[:3000])
    with pytest.raises(LogError, match=r"not a whole MATLAB file \(.*truncated"):
        read(path)


def test_h5py_is_named_where_it_is_not_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = written_mat73.save(tmp_path / "flight.mat", {"data": FLIGHT})
    monkeypatch.setitem(sys.modules, "h5py", None)
    with pytest.raises(LogError, match=r"run `pip install 'sensorfault\[matlab\]'`"):
        read(path)


def test_a_link_to_another_file_is_not_followed(tmp_path: Path) -> None:
    written_mat73.save(tmp_path / "other.mat", FLIGHT)
    path = written_mat73.save(tmp_path / "flight.mat", {"data": FLIGHT})
    with h5py.File(path, "r+") as file:
        file["elsewhere"] = h5py.ExternalLink("other.mat", "/ax")
    assert read_tables(path).keys() == {"data"}


@pytest.mark.parametrize("content", [{"name": "thor"}, {"a": 1.0}, {"data": {"x": np.zeros((3, 3))}}])
def test_nothing_to_read(tmp_path: Path, content: dict[str, object]) -> None:
    path = tmp_path / "flight.mat"
    savemat(path, content)
    with pytest.raises(LogError, match="no vectors of numbers"):
        read(path)
