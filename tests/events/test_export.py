"""Events written for other programs, and read back by libraries that share no code with the writers."""

import csv
import json
import sys
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
import pytest
from mcap.reader import make_reader
from mcap.writer import Writer

from logs.written_ros import bag2
from logs.written_ros import mcap as recorded
from sensorfault.core.extras import MissingLibrary
from sensorfault.events.event import Event
from sensorfault.events.export import write_events
from sensorfault.logs import Channel, Log, LogError, Sensor

EPOCH_S = 1_700_000_000.25
EVENTS = (
    Event(1.0, 2.0, "sensor", "gyro", "x", "offset", 9.0, 8.0, "drone"),
    Event(1.5, None, "sensor", "gnss", None, "missing", 1.5, 0.6, "drone"),
    Event(2.0, 2.0, "motion", None, None, "unknown", 4.0, 3.0, "car"),
    Event(3.0, 3.5, "sensor", None, None, "frozen", None, None, "car"),
)


def log(epoch_s: float | None = EPOCH_S) -> Log:
    time = np.arange(50) / 10
    value = np.ones((50, 2))
    channels = (Channel("x", "gyro", "rad/s"), Channel("altitude", "gnss", "m"))
    sensors = (Sensor("gyro", 0.1), Sensor("gnss", 0.1))
    return Log(time, value, np.ones((50, 2), bool), channels, sensors, epoch_s=epoch_s)


def test_json_lines(tmp_path: Path) -> None:
    write_events(EVENTS, log(), tmp_path / "events.jsonl")
    lines = (tmp_path / "events.jsonl").read_text().splitlines()
    assert [json.loads(line) for line in lines] == [event.as_dict() for event in EVENTS]


def in_a_table(event: Event) -> dict[str, object]:
    """Its fields; candidates in one cell."""
    return {**event.as_dict(), "candidates": ", ".join(event.candidates) or None}


def test_candidates_stand_in_one_cell(tmp_path: Path) -> None:
    event = replace(
        EVENTS[0],
        kind="unknown",
        sensor=None,
        channel=None,
        candidates=("wheels", "gnss"),
        found_by="wheel | gnss.speed",
    )
    write_events([event], log(), tmp_path / "events.csv")
    (row,) = csv.DictReader((tmp_path / "events.csv").read_text().splitlines())
    assert (row["candidates"], row["found_by"]) == ("wheels, gnss", "wheel | gnss.speed")
    assert "unknown which: wheels or gnss" in str(event)


@pytest.mark.parametrize("name", ["=1+1", "+x", "-x", "@SUM(A1)"])
def test_a_spreadsheet_runs_no_name(name: str, tmp_path: Path) -> None:
    write_events([replace(EVENTS[0], sensor=name, channel=name)], log(), tmp_path / "events.csv")
    (row,) = csv.DictReader((tmp_path / "events.csv").read_text().splitlines())
    assert row["sensor"] == row["channel"] == f"'{name}"
    assert float(row["start_s"]) == EVENTS[0].start_s


def test_csv_and_parquet(tmp_path: Path) -> None:
    write_events(EVENTS, log(), tmp_path / "events.csv")
    rows = list(csv.DictReader((tmp_path / "events.csv").read_text().splitlines()))
    assert [row["kind"] for row in rows] == ["offset", "missing", "unknown", "frozen"]
    assert rows[1]["end_s"] == rows[1]["channel"] == ""
    write_events(EVENTS, log(), tmp_path / "events.parquet")
    assert pl.read_parquet(tmp_path / "events.parquet").rows(named=True) == [in_a_table(event) for event in EVENTS]


@pytest.mark.parametrize("suffix", [".jsonl", ".csv", ".parquet", ".mcap", ".bag", ""])
def test_no_events_are_a_file_too(tmp_path: Path, suffix: str) -> None:
    write_events((), log(), tmp_path / f"events{suffix}")
    assert (tmp_path / f"events{suffix}").exists()
    assert [path.name for path in tmp_path.iterdir()] == [f"events{suffix}"]


def messages(path: Path) -> list[tuple[str, int, bytes]]:
    with path.open("rb") as file:
        return [(c.topic, m.log_time, m.data) for _, c, m in make_reader(file).iter_messages()]


def test_annotations_beside_the_recording(tmp_path: Path) -> None:
    source = recorded(tmp_path / "drive.mcap")
    write_events(EVENTS, log(), tmp_path / "told.mcap", source)
    own = [one for one in messages(tmp_path / "told.mcap") if "/sensorfault" not in one[0]]
    assert own == messages(source)
    states = [
        (at / 1e9 - EPOCH_S, json.loads(raw))
        for topic, at, raw in messages(tmp_path / "told.mcap")
        if topic == "/sensorfault/states"
    ]
    at = [round(time, 3) for time, _ in states]
    assert at == [0, 1, 1.5, 2, 2, 2, 3, 3.5, 4.9]
    quiet = {"gyro": "ok", "gnss": "ok", "motion": "ok", "unknown": "ok"}
    assert states[0][1] == quiet
    assert states[1][1] == {**quiet, "gyro": "offset"}
    assert states[2][1] == {**quiet, "gyro": "offset", "gnss": "missing"}
    assert states[-1][1] == {**quiet, "gnss": "missing"}
    texts = [raw for topic, _, raw in messages(tmp_path / "told.mcap") if topic == "/sensorfault/events"]
    assert len(texts) == 7
    assert b"offset on gyro.x begins (score 9, limit 8, drone)" in texts[0]


def test_a_recording_is_copied_with_all_that_it_holds(tmp_path: Path) -> None:
    source, path = tmp_path / "drive.mcap", tmp_path / "told.mcap"
    with source.open("wb") as file:
        writer = Writer(file, chunk_size=500)
        writer.start("ros2", "a recorder")
        schema = writer.register_schema("own/A", "ros2msg", b"float64 x")
        channels = [writer.register_channel(f"/{name}", "cdr", schema, {"qos": name}) for name in "ab"]
        bare = writer.register_channel("/bare", "json", 0)
        for k in range(50):
            at = int((EPOCH_S + k / 10) * 1e9)
            writer.add_message(channels[k % 2], at, bytes([k]) * 20, at - 7, k)
            writer.add_message(bare, at, b"{}", at)
        writer.add_attachment(1, 2, "camera.yaml", "text/yaml", b"f: 1")
        writer.add_metadata("car", {"plate": "M-1"})
        writer.finish()
    write_events(EVENTS, log(), path, source)
    result = {}
    for one in (source, path):
        with one.open("rb") as file:
            reader = make_reader(file)
            own = [
                (c.topic, c.metadata, s and (s.name, s.data), m.log_time, m.publish_time, m.sequence, m.data)
                for s, c, m in reader.iter_messages()
                if "/sensorfault" not in c.topic
            ]
            attached = [(one.name, one.data, one.log_time) for one in reader.iter_attachments()]
            result[one] = own, attached, list(reader.iter_metadata()), reader.get_header().profile
    assert result[path] == result[source]
    with path.open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    assert summary.statistics is not None
    assert summary.statistics.message_count == 100 + 7 + 9
    spans = [(chunk.message_start_time, chunk.message_end_time) for chunk in summary.chunk_indexes]
    assert all(end <= start for (_, end), (start, _) in pairwise(spans))  # a viewer that seeks loads one


def test_a_recording_in_several_files_is_one(tmp_path: Path) -> None:
    only = bag2(tmp_path / "drive", mcap=True, seconds=2.0)
    first = only.rename(only.with_name("drive_0.mcap"))
    first.with_name("drive_1.mcap").write_bytes(first.read_bytes())
    write_events(EVENTS, log(), tmp_path / "told.mcap", first)
    with (tmp_path / "told.mcap").open("rb") as file:
        summary = make_reader(file).get_summary()
    assert summary is not None
    topics = [channel.topic for channel in summary.channels.values()]
    assert len(topics) == len(set(topics))
    own = [one for one in messages(tmp_path / "told.mcap") if "/sensorfault" not in one[0]]
    assert len(own) == 2 * len(messages(first))


def test_of_a_damaged_recording_what_is_whole_is_copied(tmp_path: Path) -> None:
    source = recorded(tmp_path / "drive.mcap")
    sound = messages(source)
    content = bytearray(source.read_bytes())
    content[len(content) // 3] ^= 255
    source.write_bytes(content[:-2000])
    write_events(EVENTS, log(), tmp_path / "told.mcap", source)
    own = [one for one in messages(tmp_path / "told.mcap") if "/sensorfault" not in one[0]]
    assert len(sound) / 2 < len(own) < len(sound)
    assert set(own) < set(sound)


def diagnostics(path: Path) -> list[tuple[float, Any]]:
    from rosbags.highlevel import AnyReader

    with AnyReader([path]) as reader:
        return [(ns / 1e9, reader.deserialize(raw, c.msgtype)) for c, ns, raw in reader.messages()]


@pytest.mark.parametrize("name", ["events.bag", "events"])
def test_diagnostic_arrays_in_a_bag(tmp_path: Path, name: str) -> None:
    write_events(EVENTS, log(), tmp_path / name)
    result = diagnostics(tmp_path / name)
    assert len(result) == 7
    time, first = result[0]
    assert time == pytest.approx(EPOCH_S + 1)
    (status,) = first.status
    assert (status.level, status.name, status.hardware_id) == (2, "sensorfault: gyro.x", "gyro")
    assert {pair.key: pair.value for pair in status.values}["kind"] == "offset"
    levels = {(message.status[0].name, message.status[0].level) for _, message in result}
    assert ("sensorfault: gnss", 2) in levels
    assert ("sensorfault: gnss", 0) not in levels  # it goes on
    assert ("sensorfault: vehicle motion", 0) in levels


def test_without_a_clock_of_the_world_times_count_from_zero(tmp_path: Path) -> None:
    write_events(EVENTS, log(None), tmp_path / "events.bag")
    assert diagnostics(tmp_path / "events.bag")[0][0] == 1.0


def test_what_cannot_be_written(tmp_path: Path) -> None:
    with pytest.raises(LogError, match=r"not as '\.xlsx'; give another name"):
        write_events(EVENTS, log(), tmp_path / "events.xlsx")
    (tmp_path / "there").mkdir()
    with pytest.raises(LogError, match="exists already"):
        write_events(EVENTS, log(), tmp_path / "there")


def test_a_viewer_that_is_not_installed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "foxglove", None)
    with pytest.raises(MissingLibrary, match=r"pip install 'sensorfault\[viewers\]'"):
        write_events(EVENTS, log(), tmp_path / "events.mcap")
    assert not list(tmp_path.iterdir())
