"""Shared by the benchmarks: data, a line about the machine, timing, and bars that are met or missed."""

import os
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import Any

import jax
import numpy as np
from threadpoolctl import threadpool_info

import sensorfault as sf

IMU = tuple(f"{sensor}.{axis}" for sensor in ("gyro", "accelerometer") for axis in "xyz")
DATA = Path(os.environ.get("SENSORFAULT_DATA", Path(__file__).parents[2] / "shared" / "data"))


def road_log() -> sf.Log:
    """The six fast channels of the Dresden drive, 216 s at 50 Hz; without the real logs, of a simulated drive."""
    file = DATA / "road" / "dresden_50hz" / "2014-03-26-000-Data.csv"
    if file.is_file():
        log = sf.read(file)
    else:
        print(f"{file} does not exist (set SENSORFAULT_DATA): a simulated drive is used.")
        log = sf.drive(216.0).log
    return log.select(IMU)


def describe_machine() -> None:
    """Print number of cores, load, and the threads of every loaded BLAS and OpenMP library."""
    pools = {f"{p['prefix']} {p['num_threads']}" for p in threadpool_info()}
    load = ", ".join(f"{x:.2f}" for x in os.getloadavg())
    print(f"{os.cpu_count()} cores, load {load}; threads: {', '.join(sorted(pools)) or 'none'}; jax {jax.__version__}")


def seconds(work: Callable[[], Any], times: int) -> np.ndarray:
    """Times of `work` [s], for several runs."""
    took = []
    for _ in range(times):
        start = perf_counter()
        work()
        took.append(perf_counter() - start)
    return np.array(took)


class Bars:
    """The bars of this run, printed one by one, and an exit code."""

    def __init__(self) -> None:
        self.missed = 0

    def check(self, what: str, met: bool) -> None:
        print(f"{'met   ' if met else 'MISSED'}  {what}")
        self.missed += not met

    def exit_code(self) -> int:
        return int(self.missed > 0)
