"""A test rig's log as an autopilot would have written it: six inertial numbers a row, and a fix now and then."""

import struct

from logs import written_ulog
from sensorfault.logs import Log

VEHICLE = """[file.imu]
table = "IMU"
[file.fix]
table = "FIX"
[sensor.gyro]
file = "imu"
[sensor.gyro.channel]
x = { column = "gx", unit = "rad/s" }
y = { column = "gy", unit = "rad/s" }
z = { column = "gz", unit = "rad/s" }
[sensor.accelerometer]
file = "imu"
[sensor.accelerometer.channel]
x = { column = "ax", unit = "m/s^2" }
y = { column = "ay", unit = "m/s^2" }
z = { column = "az", unit = "m/s^2" }
[sensor.gnss]
file = "fix"
[sensor.gnss.channel]
east = { column = "e", unit = "m" }
north = { column = "n", unit = "m" }
"""
_KINDS = {"IMU": (132, "Qdddddd", "gx,gy,gz,ax,ay,az"), "FIX": (133, "Qdd", "e,n")}


def rows(log: Log) -> list[tuple[str, int, list[float]]]:
    """Kind, time [us] and numbers of each message."""
    found = []
    for time, value, fresh in zip(log.time, log.value, log.fresh, strict=True):
        us = round(1e6 * float(time))
        found.append(("IMU", us, value[:6].tolist()))
        if fresh[6:].any():
            found.append(("FIX", us, value[6:].tolist()))
    return found


def dataflash(log: Log) -> bytes:
    said = b""
    for name, number, form, columns in (
        ("FMT", 128, "BBnNZ", "Type,Length,Name,Format,Columns"),
        *((name, number, form, f"TimeUS,{columns}") for name, (number, form, columns) in _KINDS.items()),
    ):
        size = 89 if name == "FMT" else 3 + struct.calcsize(f"<{form}")
        said += b"\xa3\x95\x80" + struct.pack(
            "<BB4s16s64s", number, size, name.encode(), form.encode(), columns.encode()
        )
    for name, us, numbers in rows(log):
        number, form, _ = _KINDS[name]
        said += b"\xa3\x95" + bytes([number]) + struct.pack(f"<{form}", us, *numbers)
    return said


def dataflash_text(log: Log) -> bytes:
    said = "FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\n"
    for name, (number, form, columns) in _KINDS.items():
        said += f"FMT, {number}, 40, {name}, {form}, TimeUS,{columns}\n"
    return (said + "".join(f"{name}, {us}, {', '.join(map(repr, n))}\n" for name, us, n in rows(log))).encode()


def ulog(log: Log) -> bytes:
    message = written_ulog.message
    said = written_ulog.HEAD
    for name, (_, _, columns) in _KINDS.items():
        fields = "".join(f"double {one};" for one in columns.split(","))
        said += message("F", f"{name}:uint64_t timestamp;{fields}".encode())
    said += b"".join(message("A", struct.pack("<BH", 0, i) + name.encode()) for i, name in enumerate(_KINDS))
    return said + b"".join(
        message("D", struct.pack(f"<HQ{len(n)}d", list(_KINDS).index(name), us, *n)) for name, us, n in rows(log)
    )


WRITTEN = {".ulg": ulog, ".bin": dataflash, ".log": dataflash_text}
