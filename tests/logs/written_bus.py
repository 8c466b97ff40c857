"""A drive as MDF and as a recorded CAN bus, by asammdf's, python-can's and cantools' own writers."""

from collections.abc import Iterator
from pathlib import Path

import can
import cantools
import numpy as np
from asammdf import MDF, Signal

START_S = 1_700_000_000.0
ROWS = 60
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


def _database(path: Path) -> None:
    path.with_name("car.dbc").write_text(DATABASE)
