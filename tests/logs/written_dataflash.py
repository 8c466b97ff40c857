"""DataFlash logs, written byte by byte: shares no code with the reader."""

import struct

import numpy as np

FMT = 128
KINDS = {  # number, format, columns
    "GPS": (130, "BIHBfffffffI", "Status,TimeMS,Week,NSats,HDop,Lat,Lng,RelAlt,Alt,Spd,VZ,T"),
    "ATT": (131, "Ifff", "TimeMS,Roll,Pitch,Yaw"),
    "IMU": (132, "QBffffff", "TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ"),
    "MSG": (133, "Z", "Message"),
}
PLAIN = {"Z": "64s"}
RANDOM = np.random.default_rng(5)


def message(kind: str, *values: object) -> bytes:
    number, form, _ = KINDS[kind]
    return b"\xa3\x95" + bytes([number]) + struct.pack("<" + "".join(PLAIN.get(c, c) for c in form), *values)


def formats() -> bytes:
    said = b""
    own = ("FMT", FMT, "BBnNZ", "Type,Length,Name,Format,Columns")
    for name, number, form, columns in (own, *((name, *kind) for name, kind in KINDS.items())):
        plain = "BB4s16s64s" if name == "FMT" else "".join(PLAIN.get(c, c) for c in form)
        row = (number, struct.calcsize("<" + plain) + 3, name.encode(), form.encode(), columns.encode())
        said += b"\xa3\x95" + bytes([FMT]) + struct.pack("<BB4s16s64s", *row)
    return said


def flight(imus: int = 1, seconds: float = 10.0) -> bytes:
    """Attitude and IMU at 50 Hz, fixes at 5 Hz on GPS time with the autopilot's own beside it."""
    said = formats() + message("MSG", b"hello")
    for k in range(round(50 * seconds)):
        ms = 3000 + 20 * k
        for i in range(imus):
            gyro = RANDOM.normal(0, 0.1, 3)
            said += message("IMU", 1000 * ms, i, *gyro, i + 0.1 * np.sin(k), 0.0, -9.8 + RANDOM.normal(0, 0.1))
        said += message("ATT", ms, 10 * np.sin(k / 50), 5 * np.cos(k / 40), 180 + 170 * np.sin(k / 100))
        if k % 10 == 0:
            fix = (1.5, 30.1 + 1e-4 * k, -97.9, k / 10, 300 + k / 10, 3.0 + 0.1 * (k % 7), 0.1 * np.sin(k), ms)
            said += message("GPS", 3, 388000000 + 20 * k, 1815, 9, *fix)
    return said
