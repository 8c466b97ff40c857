"""Protocol buffers in an MCAP: Foxglove's schemas from its own writer, and types of the tests' own."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from google.protobuf.descriptor_pb2 import DescriptorProto, FieldDescriptorProto, FileDescriptorProto, FileDescriptorSet
from google.protobuf.descriptor_pool import DescriptorPool
from google.protobuf.message_factory import GetMessageClass
from mcap.writer import Writer

from logs import written_foxglove
from logs.written_foxglove import START_NS
from sensorfault.logs import LogError, VehicleFile, guess, read
from sensorfault.logs.readers.formats import read_tables

NUMBER, TEXT, MESSAGE = (
    FieldDescriptorProto.TYPE_DOUBLE,
    FieldDescriptorProto.TYPE_STRING,
    FieldDescriptorProto.TYPE_MESSAGE,
)


def test_foxglove_messages_are_sensors_like_their_twins_of_ros(tmp_path: Path) -> None:
    path = written_foxglove.mcap(tmp_path / "drive.mcap")
    vehicle = guess(path)
    assert VehicleFile.parse(vehicle.to_toml()) == vehicle
    log = read(path, vehicle)
    assert log.epoch_s == pytest.approx(START_NS / 1e9, abs=1e-6)
    assert log.duration_s == pytest.approx(1.98)
    time = np.arange(100) / 50
    units = {channel.path: channel.unit for channel in log.channels}
    for path_, unit, expected in (
        ("gnss.latitude", "rad", np.deg2rad(48 + 1e-5 * time)),
        ("gnss.altitude", "m", 500 + np.arange(100) % 7 / 10),
        ("velocity.x", "m/s", 1 + time),
        ("gyro.z", "rad/s", np.sin(time)),
        ("attitude.roll", "rad", 0.2 * time),
        ("local_position.y", "m", 2 * time),
    ):
        np.testing.assert_allclose(log.value[:, log.index(path_)], expected, atol=1e-9, err_msg=path_)
        assert units[path_] in (unit, "deg"), path_


def test_what_a_message_lacks_is_unknown(tmp_path: Path) -> None:
    tables = read_tables(written_foxglove.mcap(tmp_path / "drive.mcap"))
    frame = tables["/gps"].frame
    assert frame["velocity.x"][:50].is_nan().all()
    np.testing.assert_allclose(frame["velocity.x"][50:], np.arange(50, 100) / 50)
    assert tables["/gps"].time == "timestamp"
    np.testing.assert_array_equal(frame["timestamp"], START_NS + 20_000_000 * np.arange(100))
    joints = tables["/joints"].frame
    np.testing.assert_allclose(joints["joints[1].velocity"], -1 - np.arange(100) / 50)
    assert joints["joints[0].velocity"].is_nan().all()


def field(
    number: int, name: str, kind: Any, of: str = "", several: bool = False, may_lack: bool = False
) -> FieldDescriptorProto:
    label = FieldDescriptorProto.LABEL_REPEATED if several else FieldDescriptorProto.LABEL_OPTIONAL
    one = FieldDescriptorProto(name=name, number=number, type=kind, type_name=of or None, label=label)
    if may_lack:
        one.oneof_index, one.proto3_optional = 0, True
    return one


def described() -> list[FileDescriptorProto]:
    """Two files: a wheel, and a car that has wheels, may have a speed, and may pull another car."""
    wheel = DescriptorProto(name="Wheel", field=[field(1, "turn", NUMBER), field(2, "maker", TEXT)])
    car = DescriptorProto(
        name="Car",
        field=[
            field(1, "speed", NUMBER, may_lack=True),
            field(2, "wheel", MESSAGE, ".own.Wheel", several=True),
            field(3, "pair", NUMBER, several=True),
            field(4, "pulls", MESSAGE, ".own.Car"),
            field(5, "spare", MESSAGE, ".own.Wheel"),
        ],
    )
    car.oneof_decl.add(name="_speed")
    return [
        FileDescriptorProto(
            name="car.proto", package="own", syntax="proto3", dependency=["wheel.proto"], message_type=[car]
        ),
        FileDescriptorProto(name="wheel.proto", package="own", syntax="proto3", message_type=[wheel]),
    ]


def written(path: Path, describe: Callable[[], list[FileDescriptorProto]] = described, kind: str = "own.Car") -> Path:
    """Cars beside a channel of flatbuffers."""
    pool = DescriptorPool()
    for file in reversed(described()):
        pool.Add(file)
    car = GetMessageClass(pool.FindMessageTypeByName("own.Car"))
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start()
        said = FileDescriptorSet(file=describe()).SerializeToString()
        channel = writer.register_channel("/car", "protobuf", writer.register_schema(kind, "protobuf", said))
        flat = writer.register_channel("/flat", "flatbuffer", writer.register_schema("Flat", "flatbuffer", b"\1\2"))
        for k in range(20):
            one = car(wheel=[{"turn": k}, {"turn": -k}], pair=[k, 2.0 * k], pulls={"speed": 5.0})
            if k % 2:
                one.speed = 0.0
            ns = START_NS + 10**8 * k
            writer.add_message(channel, ns, one.SerializeToString(), ns)
            writer.add_message(flat, ns, b"\1\2", ns)
        writer.finish()
    return path


def test_any_type_is_read_by_its_description(tmp_path: Path) -> None:
    (table,) = read_tables(written(tmp_path / "car.mcap")).values()
    assert set(table.frame.columns) == {
        "received_time", "speed", "wheel[0].turn", "wheel[1].turn", "pair[0]", "pair[1]", "spare.turn",
    }  # fmt: skip
    np.testing.assert_array_equal(table.frame["wheel[1].turn"], -np.arange(20.0))
    np.testing.assert_array_equal(table.frame["pair[1]"], 2 * np.arange(20.0))
    np.testing.assert_array_equal(table.frame["speed"], [np.nan, 0.0] * 10)  # not told, and told to be 0
    assert table.frame["spare.turn"].is_nan().all()
    assert "car.mcap: topics of unknown type left out: /flat (Flat, flatbuffer)." in table.notes


@pytest.mark.parametrize(
    ("describe", "kind"),
    [(lambda: described()[:1], "own.Car"), (described, "own.Truck"), (list, "own.Car")],
)
def test_a_type_that_is_not_described_is_left_out_and_said(
    tmp_path: Path, describe: Callable[[], list[FileDescriptorProto]], kind: str
) -> None:
    with pytest.raises(LogError, match=rf"left out: /car \({kind}, protobuf\), /flat"):
        read(written(tmp_path / "car.mcap", describe, kind))
