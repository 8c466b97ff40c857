"""An hour of driving through the ELM monitor, a fleet of 256, and the time of `sensorfault --help`.

The hour is simulated: no real log at hand is that long. Compiling is not counted, and printed.
"""

import subprocess
import sys
from functools import partial
from pathlib import Path
from time import perf_counter

import jax
import numpy as np
from common import IMU, Bars, describe_machine, seconds

import sensorfault as sf
from sensorfault.core.types import Report, Verdict
from sensorfault.runtime.replay import replay_log
from sensorfault.runtime.runners import fleet, replay, samples

HOUR_S, HZ = 3600.0, 50.0
VEHICLES = 256
TIMES = 7
BAR_HOUR_S, BAR_FLEET_US, BAR_HELP_S = 1.0, 5.0, 0.5


def verdicts(report: Report) -> Verdict:
    return report.verdict


def first_and_rest(work: partial) -> tuple[float, np.ndarray]:
    """Time of the first call, which compiles, and of the later calls [s]."""
    start = perf_counter()
    jax.block_until_ready(work())
    first = perf_counter() - start
    return first, seconds(lambda: jax.block_until_ready(work()), TIMES)


def report(name: str, first: float, rest: np.ndarray, count: int) -> float:
    """Print one line; the median [s]."""
    median = float(np.median(rest))
    print(f"{name:44}{first:10.2f}{median:10.3f}{rest.min():10.3f}{median / count * 1e6:14.2f}")
    return median


def fleet_of(log: sf.Log, monitor: sf.Monitor) -> partial:
    """The hour split into 256 drives, each with its own monitor state."""
    length = len(log) // VEHICLES
    cut = slice(0, length * VEHICLES)
    time = np.broadcast_to(log.time[:length], (VEHICLES, length))
    rows = samples(time, log.value[cut].reshape(VEHICLES, length, -1), log.fresh[cut].reshape(VEHICLES, length, -1))
    states = jax.tree.map(lambda x: np.broadcast_to(x, (VEHICLES, *np.shape(x))), monitor.init())
    return partial(jax.jit(partial(fleet, keep=verdicts)), monitor, states, rows)


def main() -> int:
    log = sf.drive(HOUR_S, imu_hz=HZ).log.select(IMU)
    monitor = sf.fit(log.between(end_s=300.0), "elm-autoencoder", held_out=0).monitor
    rows = samples(log.time, log.value, log.fresh)
    plain = partial(jax.jit(partial(replay, keep=verdicts)), monitor, monitor.init(), rows)
    describe_machine()
    print(f"simulated drive, {len(log)} samples of {len(IMU)} channels; median and best of {TIMES}\n")
    print(f"{'':44}{'first s':>10}{'median s':>10}{'best s':>10}{'us a sample':>14}")
    jax.clear_caches()  # fitting has compiled the replay already
    hour_s = report("replay_log, the full report kept", *first_and_rest(partial(replay_log, monitor, log)), len(log))
    report("run.replay, verdicts kept", *first_and_rest(plain), len(log))
    count = len(log) // VEHICLES * VEHICLES
    fleet_s = report(f"run.fleet of {VEHICLES}, verdicts kept", *first_and_rest(fleet_of(log, monitor)), count)

    command = [Path(sys.executable).parent / "sensorfault", "--help"]
    help_s = seconds(lambda: subprocess.run(command, check=True, stdout=subprocess.DEVNULL), 2 * TIMES)
    print(f"{'sensorfault --help, whole process':44}{'':10}{np.median(help_s):10.3f}{help_s.min():10.3f}\n")
    bars, fleet_us = Bars(), fleet_s / count * 1e6
    bars.check(f"an hour replays in {hour_s:.2f} s, bar {BAR_HOUR_S:g}", hour_s <= BAR_HOUR_S)
    bars.check(f"a fleet sample costs {fleet_us:.2f} us, bar {BAR_FLEET_US:g}", fleet_us <= BAR_FLEET_US)
    bars.check(f"--help takes {np.median(help_s):.2f} s, bar {BAR_HELP_S:g}", np.median(help_s) < BAR_HELP_S)
    return bars.exit_code()


if __name__ == "__main__":
    sys.exit(main())
