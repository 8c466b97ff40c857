"""Reading logs to samples, against the bare libraries on the same files: polars for CSV, the others by their own.

All files are written here: five million rows of CSV, and 100 MB (less where the library needs minutes for that) of each
other format. `read` is timed whole, with a vehicle file: parse, clock, units, fresh marks. The best of a few: two cores
are soon busy with something else.
"""

import struct
import sys
import tempfile
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
from common import Bars, describe_machine, seconds
from pyubx2 import UBXReader
from pyulog import ULog

from sensorfault.logs import VehicleFile, guess, read

ROWS, BAR_ROWS_S, BAR_TIMES, TIMES = 5_000_000, 3.0, 1.5, 3
MEGABYTE = 1_000_000


@dataclass(frozen=True)
class Case:
    """A file and the bare library's reader; `times`: number of timed runs."""

    name: str
    path: Path
    bare: Callable[[Path], Any]
    times: int = TIMES


def csv(path: Path, rows: int) -> Path:
    random = np.random.default_rng(0)
    time = np.arange(rows) / 100
    columns = {f"a{axis} [m/s^2]": np.round(random.normal(0, 1, rows), 5) for axis in "xyz"}
    pl.DataFrame({"time [s]": time, **columns}).write_csv(path)
    return path


def ubx(path: Path, size: int) -> Path:
    """Epochs of thirty satellites."""
    dtype = np.dtype([("range", "<f8"), ("phase", "<f8"), ("doppler", "<f4"), ("rest", "u1", 12)])
    seen = np.zeros(30, dtype)
    seen["rest"][:, 1], seen["rest"][:, 6], seen["rest"][:, 10] = np.arange(1, 31), 45, 1
    with path.open("wb") as file:
        for k in range(size // 984):
            seen["range"] = 2.1e7 + 0.1 * k + np.arange(30)
            body = struct.pack("<HH", 0x1502, 16 + 960) + struct.pack("<dHbBBBH", 1000 + 0.1 * k, 2381, 18, 30, 1, 1, 0)
            body += seen.tobytes()
            byte = np.frombuffer(body, np.uint8).astype(np.int64)
            check = (byte.sum() & 255, (byte * np.arange(len(byte), 0, -1)).sum() & 255)
            file.write(b"\xb5\x62" + body + bytes(int(one) for one in check))
    return path


def ulog(path: Path, size: int) -> Path:
    """One topic of ten floats."""
    head = b"ULog\x01\x12\x35\x01" + struct.pack("<Q", 0)

    def message(kind: str, body: bytes) -> bytes:
        return struct.pack("<HB", len(body), ord(kind)) + body

    head += message("F", b"sensor_combined:uint64_t timestamp;float[3] gyro_rad;float[7] accelerometer_m_s2;")
    head += message("A", struct.pack("<BH", 0, 0) + b"sensor_combined")
    count = size // 53
    rows = np.zeros(count, np.dtype([("size", "<u2"), ("kind", "u1"), ("id", "<u2"), ("t", "<u8"), ("v", "<f4", 10)]))
    rows["size"], rows["kind"], rows["t"] = 50, ord("D"), 4000 * np.arange(count)
    rows["v"] = np.random.default_rng(0).normal(0, 0.1, (count, 10))
    path.write_bytes(head + rows.tobytes())
    return path


def bare_ubx(path: Path) -> int:
    with path.open("rb") as file:
        return sum(message is not None for _, message in UBXReader(file))


def cases(folder: Path) -> Iterator[Case]:
    yield Case("Parquet, 100 MB", parquet(folder / "drive.parquet"), lambda path: pl.read_parquet(path).to_numpy())
    yield Case("ULog, 100 MB, by pyulog", ulog(folder / "flight.ulg", 100 * MEGABYTE), lambda path: ULog(str(path)))
    yield Case("UBX, 5 MB, by pyubx2", ubx(folder / "rover.ubx", 5 * MEGABYTE), bare_ubx, 1)


def parquet(path: Path) -> Path:
    random = np.random.default_rng(0)
    columns = {f"a{axis} [m/s^2]": random.normal(0, 1, 3_200_000) for axis in "xyz"}
    pl.DataFrame({"time [s]": np.arange(3_200_000) / 100, **columns}).write_parquet(path)
    return path


def timed(path: Path, vehicle: VehicleFile, times: int = TIMES) -> float:
    def afresh() -> None:
        path.touch()  # a reader of several tables remembers the last file
        read(path, vehicle)

    return float(seconds(afresh, times).min())


def in_turn(case: Case) -> tuple[float, float]:
    """The best time of each [s], measured alternately so that other load affects both."""
    vehicle, took, bare = guess(case.path), [], []
    for _ in range(case.times):
        took.append(timed(case.path, vehicle, 1))
        bare.append(float(seconds(lambda: case.bare(case.path), 1)[0]))
    return min(took), min(bare)


def main() -> int:
    describe_machine()
    bars = Bars()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        path = csv(folder / "drive.csv", ROWS)
        took, bare = timed(path, guess(path)), float(seconds(lambda: pl.read_csv(path).to_numpy(), TIMES).min())
        print(f"{path.stat().st_size / MEGABYTE:.0f} MB of CSV, {ROWS} rows: read {took:.2f} s, polars {bare:.2f} s")
        bars.check(f"{ROWS} rows of CSV in {took:.2f} s, bar {BAR_ROWS_S:g}", took < BAR_ROWS_S)
        path.unlink()
        for case in cases(folder):
            took, bare = in_turn(case)
            print(f"{case.name:28} {case.path.stat().st_size / MEGABYTE:5.0f} MB: read {took:.2f} s, bare {bare:.2f} s")
            bars.check(
                f"{case.name}: {took / bare:.2f} times the bare library's time, bar {BAR_TIMES:g}",
                took < BAR_TIMES * bare,
            )
            case.path.unlink()
    return bars.exit_code()


if __name__ == "__main__":
    sys.exit(main())
