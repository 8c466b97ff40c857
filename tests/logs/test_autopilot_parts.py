"""An autopilot's log read part by part is the log read whole, and so is what is said of it."""

import re
import struct
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import fitted
from logs import written_ardupilot, written_dataflash, written_rig, written_ulog
from logs.small_parts import small_parts
from sensorfault.logs import Log, LogError, VehicleFile, guess, read
from sensorfault.logs.parts import read_parts
from sensorfault.logs.readers import dataflash_load
from sensorfault.logs.readers.formats import read_tables
from sensorfault.logs.readers.source import Ask, Tables
from sensorfault.runtime.detect import detect
from sensorfault.runtime.streaming import detect_long

CONTENT = {
    ".ulg": written_ulog.flight(20.0),
    ".bin": written_dataflash.flight(2, 20.0),
    ".log": written_ardupilot.text(20.0).encode(),
    ".tlog": written_ardupilot.tlog(60.0),
}


@pytest.fixture(autouse=True)
def in_small_parts() -> Iterator[None]:
    with small_parts():
        yield


def put(folder: Path, suffix: str, content: bytes) -> Path:
    path = folder / f"flight{suffix}"
    path.write_bytes(CONTENT[suffix])
    path.with_suffix(".vehicle.toml").write_text(guess(path).to_toml())
    path.write_bytes(content)
    return path


def assert_whole(path: Path) -> list[str]:
    whole, parts = read(path), list[Log]()
    said = read_parts(path, parts.append).notes
    assert len(parts) > 5
    assert all(part.channels == whole.channels and part.epoch_s == pytest.approx(whole.epoch_s) for part in parts)
    np.testing.assert_allclose(np.concatenate([part.time for part in parts]), whole.time, atol=1e-6)
    np.testing.assert_array_equal(np.concatenate([part.value for part in parts]), whole.value)
    np.testing.assert_array_equal(np.concatenate([part.fresh for part in parts]), whole.fresh)
    assert set(whole.damage) <= set(said)
    return list(said)


@pytest.mark.parametrize("suffix", CONTENT)
def test_parts_are_the_whole(tmp_path: Path, suffix: str) -> None:
    path = put(tmp_path, suffix, CONTENT[suffix])
    assert set(assert_whole(path)) == set(read(path).notes)


@pytest.mark.parametrize("suffix", CONTENT)
def test_damage_is_said_at_its_place_in_the_file(tmp_path: Path, suffix: str) -> None:
    content = CONTENT[suffix]
    at = 3 * len(content) // 4
    said = assert_whole(put(tmp_path, suffix, content[:at] + b"\n" + b"\x00" * 58 + b"\n" + content[at + 60 :]))
    place = content[:at].count(b"\n") + 1 if suffix == ".log" else at
    (where,) = (re.search(r"(?:line|byte) (\d+)", note) for note in said if "the others were read" in note)
    assert where is not None
    assert place - 200 < int(where[1]) < place + 2000


@pytest.mark.parametrize("cut", [1, 2, 3, 17, 800])
@pytest.mark.parametrize("suffix", CONTENT)
def test_a_file_that_breaks_off_is_read_so_far(tmp_path: Path, suffix: str, cut: int) -> None:
    assert any(
        "breaks off" in note or "no whole message" in note
        for note in assert_whole(put(tmp_path, suffix, CONTENT[suffix][:-cut]))
    )


def test_a_number_that_is_announced_again_forgets_nothing(tmp_path: Path) -> None:
    """pyulog takes the place of a topic for that of its forerunner, and forgets what that had."""
    announced = written_ulog.message("A", struct.pack("<BH", 0, 0) + b"sensor_combined")
    content = (
        CONTENT[".ulg"]
        + announced
        + b"".join(
            written_ulog.data("sensor_combined", 0, 25_000_000 + 20_000 * k, *np.full(6, 0.1 * k)) for k in range(50)
        )
    )
    path = put(tmp_path, ".ulg", content)
    assert_whole(path)
    assert read(path).duration_s == pytest.approx(20.98)


def test_a_topic_that_is_not_asked_for_does_not_bring_back_one_that_was(tmp_path: Path) -> None:
    announced = written_ulog.message("A", struct.pack("<BH", 0, 0) + b"cpuload")
    assert_whole(put(tmp_path, ".ulg", CONTENT[".ulg"] + announced))


def test_what_the_autopilot_could_not_write_is_counted_over_all_parts(tmp_path: Path) -> None:
    lost, data = written_ulog.message("O", struct.pack("<H", 250)), CONTENT[".ulg"]
    topics = data.index(b"cpuload", data.index(b"cpuload") + 1) + 7
    path = put(tmp_path, ".ulg", data[:topics] + lost + data[topics:] + lost)
    assert "flight.ulg: the autopilot could not write 2 times, 0.5 s in all." in assert_whole(path)


def test_kinds_that_come_later_and_units_are_those_of_the_whole(tmp_path: Path) -> None:
    """The first piece says what its messages are like; a later one has a kind of its own."""
    late = b"\xa3\x95\x80" + struct.pack("<BB4s16s64s", 140, 11, b"LATE", b"If", b"TimeMS,Value")
    late += b"".join(b"\xa3\x95\x8c" + struct.pack("<If", 24_000 + 20 * k, k) for k in range(50))
    path = put(tmp_path, ".bin", CONTENT[".bin"] + late)
    assert read_tables(path)["LATE"].frame["Value"].to_list() == list(range(50))
    assert_whole(path)


def test_what_units_are_is_said_once(tmp_path: Path) -> None:
    """Later pieces are read with what earlier ones say of their messages, but not as if it were said again."""
    unit = b"\xa3\x95\x80" + struct.pack("<BB4s16s64s", 141, 76, b"UNIT", b"QbZ", b"TimeUS,Id,Label")
    unit += b"".join(b"\xa3\x95\x8d" + struct.pack("<Qb64s", k, 100 + k, b"m/s") for k in range(3))
    tables = read_tables(put(tmp_path, ".bin", unit + CONTENT[".bin"]))
    assert tables["UNIT"].frame["Id"].to_list() == [100, 101, 102]
    assert tables["IMU"].damage == ()


@pytest.mark.parametrize("before", range(6))
def test_a_message_across_the_edge_of_a_piece_behind_rubbish(tmp_path: Path, before: int) -> None:
    content = CONTENT[".bin"]
    at = content.index(b"\xa3\x95\x84", 4000)
    path = put(tmp_path, ".bin", content[:at] + bytes(dataflash_load.PIECE_BYTES - at - before) + content[at:])
    assert len(read_tables(path)["IMU"].frame) == 1000


def test_a_description_that_nobody_understands_ends_the_log_there(tmp_path: Path) -> None:
    odd = b"\xa3\x95\x80" + struct.pack("<BB4s16s64s", 140, 15, b"ODD", b"I?", b"TimeMS,Value")
    at = CONTENT[".bin"].index(b"\xa3\x95\x84", 3 * len(CONTENT[".bin"]) // 4)
    path = put(tmp_path, ".bin", CONTENT[".bin"][:at] + odd + CONTENT[".bin"][at:])
    (result,) = (note for note in assert_whole(path) if "not to be understood" in note)
    assert at - 6000 < int(result.split("at byte ")[1].split(";")[0]) <= at
    assert read(path).duration_s == pytest.approx(15, abs=2)


@pytest.mark.parametrize("suffix", CONTENT)
def test_who_takes_the_parts_is_heard_and_may_stop(
    tmp_path: Path, suffix: str, capfd: pytest.CaptureFixture[str]
) -> None:
    def take(part: Log) -> None:
        print("heard")
        raise LogError("enough.")

    with pytest.raises(LogError, match=r"^enough\.$"):
        read_parts(put(tmp_path, suffix, CONTENT[suffix]), take)
    assert capfd.readouterr() == ("heard\n", "")


@pytest.mark.parametrize("suffix", CONTENT)
def test_what_is_said_of_the_file_has_a_place_where_its_last_part_has_no_row(tmp_path: Path, suffix: str) -> None:
    path = put(tmp_path, suffix, CONTENT[suffix] + b"\xa3\x95" + b"\x00" * 700)
    parts: list[Tables] = []
    rest = read_tables(path, Ask(part=parts.append))
    assert len(parts) > 5
    assert rest.keys() >= parts[0].keys()
    assert {one.damage for one in rest.values()} == {next(iter(rest.values())).damage} != {()}


@pytest.mark.parametrize("suffix", written_rig.WRITTEN)
def test_the_events_are_those_of_the_whole(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"flight{suffix}"
    path.write_bytes(written_rig.WRITTEN[suffix](fitted.lying().log))
    vehicle = VehicleFile.parse(written_rig.VEHICLE)
    whole = detect(fitted.model(), read(path, vehicle)).events
    with small_parts(5000):
        result = detect_long(fitted.model(), path, vehicle).events
    assert len(result) == len(whole) > 5
    for mine, theirs in zip(result, whole, strict=True):
        assert (mine.sensor, mine.channel, mine.kind) == (theirs.sensor, theirs.channel, theirs.kind)
        assert (mine.start_s, mine.end_s) == pytest.approx((theirs.start_s, theirs.end_s), abs=1e-6)


@pytest.mark.real
@pytest.mark.parametrize("name", ["pyulog_sample/sample.ulg", "copter_jd2014/jd_204405.bin"])
def test_real_flights(real_data: Path, name: str) -> None:
    """What is measured is the same; a gap of just three periods is filled in the one and not in the other."""
    path = real_data / "uav" / name
    vehicle = guess(path)
    whole, parts = read(path, vehicle), list[Log]()
    with small_parts(20_000):
        said = read_parts(path, parts.append, vehicle)
    assert len(parts) > 10
    time, value = np.concatenate([one.time for one in parts]), np.concatenate([one.value for one in parts])
    result, mine = np.isfinite(whole.value).any(axis=1), np.isfinite(value).any(axis=1)
    np.testing.assert_allclose(time[mine], whole.time[result], atol=1e-6)
    np.testing.assert_array_equal(value[mine], whole.value[result])
    assert abs(len(time) - len(whole)) < 5
    assert said.damage == whole.damage
