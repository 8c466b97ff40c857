"""ROS 1 and ROS 2 bags and MCAP: what is read, what is left out and said so, and where a broken one breaks."""

import sqlite3
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from mcap.writer import CompressionType

from logs.written_ros import START_NS, bag1, bag2, mcap
from sensorfault.logs import Log, LogError, VehicleFile, guess, read
from sensorfault.logs.readers.formats import read_tables
from sensorfault.logs.readers.source import Ask
from sensorfault.logs.readers.topics import Topics

WAYS: dict[str, Callable[[Path], Path]] = {
    "bag": lambda folder: bag1(folder / "drive.bag"),
    "bag of chunks in lz4": lambda folder: bag1(folder / "drive.bag", compress=True),
    "db3": lambda folder: bag2(folder / "drive"),
    "mcap": lambda folder: bag2(folder / "drive", mcap=True),
}


@pytest.mark.parametrize("way", WAYS)
def test_the_usual_messages_and_one_of_its_own(tmp_path: Path, way: str) -> None:
    path = WAYS[way](tmp_path)
    vehicle = guess(path)
    assert VehicleFile.parse(vehicle.to_toml()) == vehicle
    log = read(path, vehicle)
    assert log.duration_s == pytest.approx(3.98, abs=1e-6)
    assert log.epoch_s == pytest.approx(START_NS / 1e9, abs=1e-3)
    time = np.arange(200) / 50
    np.testing.assert_allclose(log.value[:, log.index("imu_data_attitude.roll")], 0.2 * time, atol=1e-9)
    assert log.value[:, log.index("accelerometer.z")].mean() == pytest.approx(9.8, abs=0.05)
    assert log.value[0, log.index("gnss.latitude")] == pytest.approx(np.deg2rad(48))
    assert log.value[0, log.index("barometer.pressure")] == 95_000
    at = log.fresh[:, log.index("gnss.latitude")]
    np.testing.assert_array_equal(np.flatnonzero(at), np.arange(0, 200, 10))
    assert "/cmd_vel" not in {file.table for file in vehicle.files}
    units = {channel.path: channel.unit for channel in log.channels}
    assert (units["imu_data_gyro.x"], units["accelerometer.x"], units["barometer.pressure"]) == ("rad/s", "m/s^2", "Pa")
    assert log.value[180, log.index("twist.x")] == pytest.approx(1 + 3.6)
    assert units["twist.x"] == "m/s"
    assert (units["position.position_3"], units["velocity.velocity_1"]) == ("rad", "rad/s")
    said = " ".join(vehicle.notes)
    assert "topics without numbers left out: /chatter" in said
    assert "fields that are not measurements left out: /own.scan (40 numbers), " in said
    assert "left out, as they are commands: /cmd_vel" in said
    assert log.damage == ()


def test_any_field_by_its_path(tmp_path: Path) -> None:
    path = bag1(tmp_path / "drive.bag")
    described = '[file.own]\ntable = "/own"\nunit = "ns"\n[sensor.wheel.channel]\nturn = { column = "pair[1]" }\n'
    log = read(path, VehicleFile.parse(described))
    assert log.value[:, 0] == pytest.approx(-np.arange(200) / 50, abs=1e-6)
    assert set(read_tables(path, Ask(frozenset({"/own"})))) == {"/own"}


def test_stamps_count_and_reception_where_there_is_none(tmp_path: Path) -> None:
    tables = read_tables(bag2(tmp_path / "drive"))
    assert tables["/imu/data"].time == "header.stamp"
    assert tables["/own"].time == "received_time"
    assert tables["/imu/data"].frame["header.stamp"][0] == START_NS
    assert tables["/own"].frame["received_time"][0] == START_NS + 3_000_000


@pytest.mark.parametrize(
    ("stamp_s", "said"),
    [
        (lambda k: 5.0 + k / 10, "are from another clock, -1.7e+09 s off the recording's"),
        (lambda k: 1_700_000_000.0, "do not increase"),
        (lambda k: 1_700_000_000.0 + k / 10, None),
        (lambda k: 0.0, None),
    ],
)
def test_two_clocks(stamp_s: Callable[[int], float], said: str | None) -> None:
    topics = Topics(Path("drive.bag"), Ask())
    for k in range(20):
        second, rest = divmod(round(stamp_s(k) * 10**9), 10**9)
        message = {"header": {"stamp": {"sec": second, "nanosec": rest}}, "x": k}
        topics.take("/a", "Odd", START_NS + k * 10**8, message)
    table = topics.tables()[0]["/a"]
    believed = said is None and stamp_s(0) > 0
    assert table.time == ("header.stamp" if believed else "received_time")
    assert [said in note for note in table.notes] == ([] if said is None else [True])


def test_a_topic_of_which_no_message_can_be_decoded_is_no_table() -> None:
    topics = Topics(Path("drive.bag"), Ask())
    with pytest.raises(ValueError, match="invalid literal"):
        topics.take("/a", "Odd", START_NS, {"header": {"stamp": {"sec": "x", "nanosec": 0}}, "x": 1})
    assert topics.tables()[0] == {}


def test_json_in_an_mcap_beside_what_nobody_decodes(tmp_path: Path) -> None:
    log = read(mcap(tmp_path / "drive.mcap"))
    np.testing.assert_allclose(log.value[:, log.index("local_position.x")], np.arange(200) / 50)
    assert "drive.mcap: topics of unknown type left out: /image (foxglove.Image, protobuf)." in log.notes


def parts(folder: Path, content: bytes, suffix: str) -> Log:
    path = folder / f"broken{suffix}"
    path.write_bytes(content)
    return read(path)


BREAKING: dict[str, Callable[[Path], Path]] = {
    **{way: WAYS[way] for way in WAYS if way != "db3"},
    "bag of one chunk": lambda folder: bag1(folder / "drive.bag", chunk_bytes=10**9),
    "mcap of chunks in lz4": lambda folder: mcap(folder / "drive.mcap"),
}


@pytest.mark.parametrize("way", BREAKING)
def test_a_recording_that_breaks_off_is_read_so_far_and_says_where(tmp_path: Path, way: str) -> None:
    path = BREAKING[way](tmp_path)
    whole = path.read_bytes()
    at = len(whole) // 2
    log = parts(tmp_path, whole[:at], path.suffix)
    assert 1.0 < log.duration_s < 3.5
    (result,) = log.damage
    assert "breaks off, or has an invalid record, at byte" in result
    assert 0 <= at - int(result.split("at byte ")[1].split(";")[0]) < (40_000 if "lz4" in way else 200_000)


@pytest.mark.parametrize("compression", [CompressionType.NONE, CompressionType.LZ4])
def test_a_chunk_with_a_wrong_checksum_is_left_out_and_said(tmp_path: Path, compression: CompressionType) -> None:
    whole = bytearray(mcap(tmp_path / "drive.mcap", compression=compression).read_bytes())
    whole[
        bytes(whole).index(b"position", len(whole) // 3) + 10
        if compression == CompressionType.NONE
        else len(whole) // 3
    ] ^= 255
    log = parts(tmp_path, bytes(whole), ".mcap")
    assert 150 < len(log) < 200
    assert log.duration_s == pytest.approx(3.98)
    assert "1 chunks cannot be unpacked, the first at byte" in log.damage[0]


def test_a_database_that_breaks_off(tmp_path: Path) -> None:
    whole = bag2(tmp_path / "drive").read_bytes()
    log = parts(tmp_path, whole[: len(whole) // 2 // 4096 * 4096], ".db3")
    assert 0.5 < log.duration_s < 3.9
    assert "the database broken.db3 cannot be read further" in log.damage[0]
    assert "it ends at message" in log.damage[0]


def test_a_bag_in_parts_is_one_log(tmp_path: Path) -> None:
    folder = bag2(tmp_path / "drive").parent
    first, second = folder / "drive_0.db3", folder / "drive_1.db3"
    (folder / "drive.db3").rename(first)
    second.write_bytes(first.read_bytes())
    for path, kept in ((first, "<"), (second, ">=")):
        with sqlite3.connect(path) as base:
            base.execute(f"DELETE FROM messages WHERE NOT timestamp {kept} ?", (START_NS + 2 * 10**9,))
        base.close()
    assert read(folder).duration_s == pytest.approx(3.98)
    assert read(second).duration_s < 2.0


@pytest.mark.parametrize("suffix", [".bag", ".db3", ".mcap"])
@pytest.mark.parametrize("content", [b"", b"\x00" * 300, b"SQLite format 3\x00" + b"\xff" * 500, b"#ROSBAG V2.0\n"])
def test_what_is_no_recording(tmp_path: Path, suffix: str, content: bytes) -> None:
    with pytest.raises(LogError) as error:
        parts(tmp_path, content, suffix)
    assert "\n" not in str(error.value)
    assert str(error.value).endswith(".")
