"""Long logs with six channels, written block by block, to measure reading by parts."""

import json
import struct
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import polars as pl
from pymavlink.dialects.v20 import ardupilotmega as mav

HZ, BLOCK = 100, 250_000  # rows written at a time
NAMES = [f"gyro_{axis} [rad/s]" for axis in "xyz"] + [f"acc_{axis} [m/s^2]" for axis in "xyz"]


def rows(start: int, count: int) -> dict[str, np.ndarray]:
    random = np.random.default_rng(start)
    time = (start + np.arange(count)) / HZ
    cause = np.sin(np.outer(time, (0.9, 1.7, 2.3)))
    value = cause @ np.random.default_rng(7).uniform(-1, 1, (3, 6)) + random.uniform(-0.1, 0.1, (count, 6))
    return {"time [s]": time, **dict(zip(NAMES, value.T, strict=True))}


def blocks() -> Iterator[tuple[int, dict[str, np.ndarray]]]:
    """Endless blocks of rows, with the number of each block's first row."""
    start = 0
    while True:
        yield start, rows(start, BLOCK)
        start += BLOCK


def csv(path: Path, size: int) -> Path:
    with path.open("wb") as file:
        for start, columns in blocks():
            pl.DataFrame(columns).write_csv(file, include_header=start == 0, float_precision=6)
            if file.tell() >= size:
                return path
    raise AssertionError


def parquet(path: Path, size: int) -> Path:
    beside = csv(path.with_suffix(".csv"), round(1.2 * size))  # six digits take as many bytes as a number, nearly
    pl.scan_csv(beside).sink_parquet(path, compression="uncompressed")
    beside.unlink()
    return path


def mcap(path: Path, size: int) -> Path:
    from mcap.writer import CompressionType, Writer

    with path.open("wb") as file:
        writer = Writer(file, compression=CompressionType.NONE)
        writer.start()
        topic = writer.register_channel("/imu", "json", writer.register_schema("Imu", "jsonschema", b"{}"))
        for start, columns in blocks():
            for k, row in enumerate(zip(*(columns[name].tolist() for name in NAMES), strict=True), start):
                ns = 1_700_000_000 * 10**9 + k * 10**9 // HZ
                fields = {"gyro": dict(zip("xyz", row[:3], strict=True)), "acc": dict(zip("xyz", row[3:], strict=True))}
                writer.add_message(topic, ns, json.dumps(fields).encode(), ns)
            if file.tell() >= size:
                break
        writer.finish()
    return path


def binary(path: Path, size: int, head: bytes, record: np.dtype, fill: Callable[[np.ndarray], None]) -> Path:
    """A head, and one record for each row with `us`, `v` and the fields that `fill` sets."""
    with path.open("wb") as file:
        file.write(head)
        for start, columns in blocks():
            put = np.zeros(BLOCK, record)
            fill(put)
            put["us"] = 10**6 + (start + np.arange(BLOCK)) * (10**6 // HZ)
            put["v"] = np.column_stack([columns[name] for name in NAMES])
            file.write(put.tobytes())
            if file.tell() >= size:
                return path
    raise AssertionError


def ulog(path: Path, size: int) -> Path:
    def message(kind: str, body: bytes) -> bytes:
        return struct.pack("<HB", len(body), ord(kind)) + body

    head = b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 0)
    head += message("F", b"sensor_combined:uint64_t timestamp;float[3] gyro_rad;float[3] accelerometer_m_s2;")
    head += message("A", struct.pack("<BH", 0, 0) + b"sensor_combined")
    record = np.dtype([("size", "<u2"), ("kind", "u1"), ("id", "<u2"), ("us", "<u8"), ("v", "<f4", 6)])

    def fill(put: np.ndarray) -> None:
        put["size"], put["kind"] = 34, ord("D")

    return binary(path, size, head, record, fill)


def dataflash(path: Path, size: int) -> Path:
    def described(number: int, name: bytes, form: bytes, columns: bytes, length: int) -> bytes:
        return b"\xa3\x95\x80" + struct.pack("<BB4s16s64s", number, length, name, form, columns)

    head = described(128, b"FMT", b"BBnNZ", b"Type,Length,Name,Format,Columns", 89)
    head += described(132, b"IMU", b"QBffffff", b"TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ", 36)
    record = np.dtype([("head", "S2"), ("kind", "u1"), ("us", "<u8"), ("i", "u1"), ("v", "<f4", 6)])

    def fill(put: np.ndarray) -> None:
        put["head"], put["kind"] = b"\xa3\x95", 132

    return binary(path, size, head, record, fill)


def dataflash_text(path: Path, size: int) -> Path:
    with path.open("wb") as file:
        file.write(b"FMT, 128, 89, FMT, BBnNZ, Type,Length,Name,Format,Columns\n")
        file.write(b"FMT, 131, 40, IMU, QBffffff, TimeUS,I,GyrX,GyrY,GyrZ,AccX,AccY,AccZ\n")
        for start, columns in blocks():
            us = 10**6 + (start + np.arange(BLOCK)) * (10**6 // HZ)
            values = {name: columns[name] for name in NAMES}
            frame = pl.DataFrame({"kind": ["IMU"] * BLOCK, "us": us, "i": np.zeros(BLOCK, int), **values})
            frame.write_csv(file, include_header=False, float_precision=6)
            if file.tell() >= size:
                return path
    raise AssertionError


def tlog(path: Path, size: int) -> Path:
    """The packets of one block, repeated: the time is before each packet and not covered by its checksum."""
    link, columns = mav.MAVLink(None, 1, 1), rows(0, BLOCK // 10)
    numbers = np.round(1000 * np.column_stack([columns[name] for name in (*NAMES[3:], *NAMES[:3])])).astype(int)
    packets = [
        bytes(mav.MAVLink_raw_imu_message(k, *row, 100, 200, 300, 1, 2500).pack(link))
        for k, row in enumerate(numbers.tolist())
    ]
    packets = [packet for packet in packets if len(packet) == max(map(len, packets))]
    put = np.zeros(len(packets), [("us", ">u8"), ("packet", f"V{len(packets[0])}")])
    put["packet"] = np.array(packets, f"V{len(packets[0])}")
    with path.open("wb") as file:
        for start in range(0, 10**12, len(packets)):
            put["us"] = 1_700_000_000 * 10**6 + (start + np.arange(len(packets))) * (10**6 // HZ)
            file.write(put.tobytes())
            if file.tell() >= size:
                return path
    raise AssertionError


WAYS = {
    ".csv": csv,
    ".parquet": parquet,
    ".mcap": mcap,
    ".ulg": ulog,
    ".bin": dataflash,
    ".log": dataflash_text,
    ".tlog": tlog,
}
