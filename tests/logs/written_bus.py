"""A drive as MDF and as a recorded CAN bus, by asammdf's, python-can's and cantools' own writers."""

from collections.abc import Iterator
from pathlib import Path

import can
import cantools
import numpy as np
from asammdf import MDF, Signal, Source

START_S = 1_700_000_000.0
ROWS = 60
TRUCK = """VERSION ""
NS_ :
BS_:
BU_: ECU
BO_ 2364540158 EEC1: 8 ECU
 SG_ EngineSpeed : 24|16@1+ (0.125,0) [0|8031] "rpm" ECU
 SG_ Count : 40|8@1+ (1,0) [0|250] "" ECU
BA_DEF_ "ProtocolType" STRING;
BA_DEF_ BO_ "VFrameFormat" ENUM "StandardCAN","ExtendedCAN","reserved","J1939PG";
BA_DEF_DEF_ "ProtocolType" "";
BA_DEF_DEF_ "VFrameFormat" "J1939PG";
BA_ "ProtocolType" "J1939";
BA_ "VFrameFormat" BO_ 2364540158 3;
"""
DATABASE = """VERSION ""
NS_ :
BS_:
BU_: ECU
BO_ 256 Wheels: 8 ECU
 SG_ FrontLeft : 0|16@1+ (0.01,0) [0|655] "km/h" ECU
 SG_ FrontRight : 16|16@1+ (0.01,0) [0|655] "km/h" ECU
BO_ 512 Motion: 8 ECU
 SG_ YawRate : 0|16@1- (0.005,0) [-163|163] "deg/s" ECU
 SG_ Gear : 16|8@1+ (1,0) [0|8] "" ECU
"""


def mdf(path: Path, count: int = ROWS, compression: int = 0) -> Path:
    time = np.arange(count) / 50
    with MDF(version="4.10") as file:
        axes = [Signal(np.sin(time), time, name=f"a{axis}", unit="m/s^2") for axis in "xy"]
        words = np.array([b"on", b"off"] * (count // 2))
        file.append([*axes, Signal(words, time, name="state", encoding="utf-8")], comment="imu")
        file.append([Signal(36 + time[::5], time[::5], name="speed", unit="km/h")], comment="wheel")
        file.save(path, overwrite=True, compression=compression)
    return path


def frames(count: int = ROWS) -> Iterator[can.Message]:
    database = cantools.database.load_string(DATABASE, "dbc")
    for k in range(count):
        said = (
            ("Wheels", 0.0, {"FrontLeft": 36 + 0.1 * k, "FrontRight": 36 - 0.1 * k}),
            ("Motion", 0.004, {"YawRate": 0.5 * (k % 7), "Gear": 3}),
        )
        for name, late, signals in said:
            number, data = database.get_message_by_name(name).frame_id, database.encode_message(name, signals)
            yield can.Message(timestamp=START_S + k / 50 + late, arbitration_id=number, data=data, is_extended_id=False)
        yield can.Message(timestamp=START_S + k / 50 + 0.006, arbitration_id=0x300, data=bytes(8), is_extended_id=False)


def blf(path: Path, count: int = ROWS) -> Path:
    _database(path)
    with can.BLFWriter(path) as writer:
        for frame in frames(count):
            writer.on_message_received(frame)
    return path


def asc(path: Path, count: int = ROWS) -> Path:
    _database(path)
    with can.ASCWriter(path) as writer:
        for frame in frames(count):
            writer.on_message_received(frame)
    return path


def candump(path: Path, count: int = ROWS) -> Path:
    _database(path)
    with can.CanutilsLogWriter(path) as writer:
        for frame in frames(count):
            writer.on_message_received(frame)
    return path


def framed(path: Path, count: int = ROWS) -> Path:
    """The frames as a bus logger writes them to MDF, undecoded."""
    _database(path)
    sent = list(frames(count))
    shapes = {"BusChannel": "u1", "ID": "u4", "IDE": "u1", "DLC": "u1", "DataLength": "u1", "DataBytes": "(8,)u1"}
    rows = np.zeros(len(sent), [(f"CAN_DataFrame.{name}", shape) for name, shape in shapes.items()])
    rows["CAN_DataFrame.BusChannel"] = 1
    rows["CAN_DataFrame.ID"] = [frame.arbitration_id for frame in sent]
    rows["CAN_DataFrame.DLC"] = rows["CAN_DataFrame.DataLength"] = 8
    rows["CAN_DataFrame.DataBytes"] = [list(frame.data.ljust(8, b"\0")) for frame in sent]
    source = Source("CAN1", "CAN1", "", source_type=Source.SOURCE_BUS, bus_type=Source.BUS_TYPE_CAN)
    with MDF(version="4.11") as file:
        time = np.array([frame.timestamp - START_S for frame in sent])
        file.append([Signal(rows, time, name="CAN_DataFrame", source=source)], acq_source=source, acq_name="CAN1")
        file.groups[0].channel_group.flags |= 6  # a group of bus events
        file.save(path, overwrite=True)
    return path


def truck(path: Path, count: int = ROWS) -> Path:
    """A bus of SAE J1939: the database has a source of its own, the frames another."""
    path.with_name("truck.dbc").write_text(TRUCK)
    with can.BLFWriter(path) as writer:
        for k in range(count):
            data = bytes([0, 0, 0, *int(800 / 0.125).to_bytes(2, "little"), k % 250, 0, 0])
            writer.on_message_received(
                can.Message(timestamp=START_S + k / 50, arbitration_id=0x0CF00400, data=data, is_extended_id=True)
            )
    return path


def _database(path: Path) -> None:
    path.with_name("car.dbc").write_text(DATABASE)
