"""Peak memory of `detect --by-parts` on a long file and on its half: it must not grow with the file.

Each is run in a process of its own; what is compared is the largest resident memory of that process. Files are made
here, see long_logs.py.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path
from time import perf_counter

import click
from common import Bars, describe_machine
from long_logs import WAYS

from sensorfault.logs import VehicleFile, guess, read
from sensorfault.methods.fit import fit
from sensorfault.runtime.store import save

MEGABYTE, BAR_TIMES = 10**6, 1.1
SLOW = {".tlog": 10}  # the file is smaller by this factor: pymavlink needs a second for two megabytes


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
    """Peak memory on a long file divided by that on its half."""
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
            for megabytes in (size // 2 // SLOW.get(way, 1), size // SLOW.get(way, 1)):
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
