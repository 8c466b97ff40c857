"""Peak memory of `detect --by-parts` on a long file and on its half: it must not grow with the file.

Each is run in a process of its own; what is compared is the largest resident memory of that process. Files are made
here: CSV and Parquet of a test rig's eight channels, and an MCAP of JSON messages.
"""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path
from time import perf_counter

import click
import numpy as np
import polars as pl
from common import Bars, describe_machine

from sensorfault.logs import VehicleFile, guess, read
from sensorfault.methods.fit import fit
from sensorfault.store import save

MEGABYTE, BAR_TIMES = 10**6, 1.1
HZ, BLOCK = 100, 250_000  # rows that are made at a time
NAMES = [f"gyro_{axis} [rad/s]" for axis in "xyz"] + [f"acc_{axis} [m/s^2]" for axis in "xyz"]


def rows(start: int, count: int) -> dict[str, np.ndarray]:
    random = np.random.default_rng(start)
    time = (start + np.arange(count)) / HZ
    cause = np.sin(np.outer(time, (0.9, 1.7, 2.3)))
    value = cause @ np.random.default_rng(7).uniform(-1, 1, (3, 6)) + random.uniform(-0.1, 0.1, (count, 6))
    return {"time [s]": time, **dict(zip(NAMES, value.T, strict=True))}


def csv(path: Path, size: int) -> Path:
    with path.open("wb") as file:
        start = 0
        while file.tell() < size:
            pl.DataFrame(rows(start, BLOCK)).write_csv(file, include_header=start == 0, float_precision=6)
            start += BLOCK
    return path


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
        start = 0
        while file.tell() < size:
            columns = rows(start, BLOCK)
            for k, row in enumerate(zip(*(columns[name].tolist() for name in NAMES), strict=True), start):
                ns = 1_700_000_000 * 10**9 + k * 10**9 // HZ
                said = {"gyro": dict(zip("xyz", row[:3], strict=True)), "acc": dict(zip("xyz", row[3:], strict=True))}
                writer.add_message(topic, ns, json.dumps(said).encode(), ns)
            start += BLOCK
        writer.finish()
    return path


WAYS = {".csv": csv, ".parquet": parquet, ".mcap": mcap}


def peak(path: Path, model: Path, vehicle: Path, *words: str) -> tuple[float, float]:
    """Largest resident memory [MB] and time [s] of `detect`."""
    start = perf_counter()
    command = [
        sys.executable,
        "-m",
        "sensorfault",
        "detect",
        str(path),
        "--model",
        str(model),
        "--vehicle",
        str(vehicle),
    ]
    process = subprocess.Popen([*command, *words], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, used = os.wait4(process.pid, 0)
    if os.waitstatus_to_exitcode(status):
        raise SystemExit(f"{path}: detect ended with {status}")
    return used.ru_maxrss / 1e3, perf_counter() - start


@click.command()
@click.option("--size", default=1000, show_default=True, help="MB of the long file; its half is the other.")
@click.option("--way", "ways", type=click.Choice(list(WAYS)), multiple=True, default=list(WAYS))
def main(size: int, ways: tuple[str, ...]) -> None:
    """Peak memory on a long file over that on its half."""
    describe_machine()
    bars = Bars()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for way in ways:
            short = WAYS[way](folder / f"fit{way}", MEGABYTE)
            vehicle, model = folder / "vehicle.toml", folder / "model.sensorfault"
            vehicle.write_text(guess(short).to_toml())
            save(fit(read(short, VehicleFile.read(vehicle)), "relative-conditioning", held_out=0.0), model)
            base, _ = peak(short, model, vehicle, "--by-parts")
            used = []
            for megabytes in (size // 2, size):
                path = WAYS[way](folder / f"drive{way}", megabytes * MEGABYTE)
                used.append(peak(path, model, vehicle, "--by-parts"))
                print(
                    f"{way:9}{path.stat().st_size / MEGABYTE:7.0f} MB: {used[-1][0]:6.0f} MB, {used[-1][1]:6.1f} s",
                    end="",
                )
                print(f"; of a short log {base:.0f} MB")
                path.unlink()
            ratio = used[1][0] / used[0][0]
            bars.check(
                f"{way}: peak of the long over that of its half {ratio:.2f}, bar {BAR_TIMES:g}", ratio < BAR_TIMES
            )
            short.unlink()
    sys.exit(bars.exit_code())


if __name__ == "__main__":
    main()
