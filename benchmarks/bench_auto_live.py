"""The default method live, on a drone with 25 channels at 200 Hz and on one with 10, against judging it all anew.

Each is fitted on one simulated flight and pushed another, sample by sample, until all windows are full; then it is
timed. A sample costs little, but once a second one of them compares all sensors: the mean counts as well as the median.
Only what is new is compared. The ratio is to what the plain way costs: once a second the last 80 s as a whole.
"""

import sys
from dataclasses import replace
from time import perf_counter_ns

import numpy as np
from common import Bars, describe_machine, seconds

import sensorfault as sf
from sensorfault.logs.table import Channel, Sensor
from sensorfault.relations.running import KEPT_S, Running
from sensorfault.runtime.compared import Comparison
from sensorfault.simulation import flapping_wing

HZ = 200.0
FULL_S, TIMED_S = 100.0, 30.0  # before anything is timed; what is timed
FEW = ("gyro", "accelerometer", "barometer", "attitude")  # ten channels
BAR_US, BAR_FEW_US, BAR_TIMES = 120.0, 60.0, 1.5


def drone(duration_s: float, seed: int) -> sf.Log:
    """A flight with two inertial units, a compass, attitude, barometer and receiver."""
    log = flapping_wing.fly(duration_s, seed, beat_hz=0.0, imu_hz=HZ).log
    chance = np.random.default_rng(seed + 100)
    log = log.select([c.path for c in log.channels if c.sensor not in ("control", "airspeed")])
    inertial = log.value[:, [*log.of("gyro"), *log.of("accelerometer")]]
    second = inertial + chance.normal(0.0, [0.002] * 3 + [0.03] * 3, inertial.shape)
    field = _field(log.value[:, list(log.of("attitude"))]) + chance.normal(0.0, 0.004, (len(log), 3))
    names = [(sensor, unit) for sensor, unit in (("gyro2", "rad/s"), ("accelerometer2", "m/s^2"), ("compass", "gauss"))]
    more = tuple(Channel(axis, sensor, unit) for sensor, unit in names for axis in "xyz")
    return replace(
        log,
        value=np.column_stack([log.value, second, field]),
        fresh=np.column_stack([log.fresh, np.ones((len(log), 9), bool)]),
        channels=(*log.channels, *more),
        sensors=(*log.sensors, *(Sensor(sensor, 1 / HZ) for sensor, _ in names)),
    )


def _field(attitude: np.ndarray) -> np.ndarray:
    """The earth's field along forward, left, up; level flight is near enough."""
    yaw = attitude[:, 2]
    return np.stack([0.2 * np.cos(yaw), 0.2 * np.sin(yaw), np.full(len(yaw), -0.4)], axis=1)


def time_pushes(live: sf.Live, log: sf.Log) -> np.ndarray:
    """Time of each push [us]."""
    took = np.empty(len(log))
    for i, row in enumerate(zip(log.time, log.value, log.fresh, strict=True)):
        start = perf_counter_ns()
        live.push(*row)
        took[i] = perf_counter_ns() - start
    return took / 1e3


def report(name: str, model: Comparison, log: sf.Log) -> tuple[float, float, float]:
    """Print one line; median and mean of the last part, and the mean of judging all anew [us]."""
    took = time_pushes(sf.Live(model), log)[log.time >= FULL_S]
    assert model.learned is not None
    running, last = Running(model.learned), log.between(log.time[-1] - KEPT_S)
    anew = 1e6 * float(np.median(seconds(lambda: running.whole(last), 5))) / HZ
    median, p99, worst = np.percentile(took, [50, 99, 100])
    print(f"{name:24}{median:9.1f}{took.mean():9.1f}{p99:9.1f}{worst / 1e3:9.1f}{anew:9.1f}")
    return float(median), float(took.mean()), anew


def main() -> int:
    fitted, flown = drone(240.0, 1), drone(FULL_S + TIMED_S, 2)
    few = [c.path for c in flown.channels if c.sensor in FEW]
    describe_machine()
    print(f"\n{'us a sample':24}{'median':>9}{'mean':>9}{'p99':>9}{'worst ms':>9}{'anew':>9}")
    bars = Bars()
    for bar, channels in ((BAR_US, [c.path for c in flown.channels]), (BAR_FEW_US, few)):
        name = f"{len(channels)} channels at {HZ:g} Hz"
        model = sf.fit(fitted.select(channels))
        assert isinstance(model, Comparison)
        median, mean, anew = report(name, model, flown.select(channels))
        bars.check(f"{name}: {median:.1f} us, median; bar {bar:g}", median <= bar)
        bars.check(f"{name}: {mean:.1f} us, mean; bar {bar:g}", mean <= bar)
        times = anew / mean
        bars.check(f"{name}: {times:.1f} times cheaper than all anew; bar {BAR_TIMES:g}", times >= BAR_TIMES)
    return bars.exit_code()


if __name__ == "__main__":
    sys.exit(main())
