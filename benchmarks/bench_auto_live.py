"""The default method live: a drone with 25 channels at 200 Hz, one with 10, and one of 256 in turns.

Each is fitted on one simulated flight and pushed another, sample by sample, from its third minute on, when all windows
are full. A sample costs little, but every second one of them compares all sensors: the mean counts as well as the
median. Beside them the whole flight in one call, which judges the same. Times of one run, on one core each.
"""

import sys
from dataclasses import replace
from time import perf_counter, perf_counter_ns

import numpy as np
from common import Bars, describe_machine

import sensorfault as sf
from sensorfault.logs.table import Channel, Sensor
from sensorfault.simulation import flapping_wing

HZ = 200.0
FULL_S, TIMED_S = 100.0, 30.0  # before anything is timed; what is timed
FEW = ("gyro", "accelerometer", "barometer", "attitude")  # ten channels
BAR_US, BAR_FEW_US, BAR_FLEET_US = 120.0, 60.0, 5.0
VEHICLES = 256


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


def report(name: str, model: sf.Model, log: sf.Log) -> np.ndarray:
    """Print one line; the times of the last part [us]."""
    live = sf.Live(model)
    took = time_pushes(live, log)[log.time >= FULL_S]
    start = perf_counter()
    found = sf.detect(model, log)
    whole = 1e6 * (perf_counter() - start) / len(log)
    median, p99, worst = np.percentile(took, [50, 99, 100])
    print(f"{name:24}{median:9.1f}{took.mean():9.1f}{p99:9.1f}{worst / 1e3:9.1f}{whole:9.1f}{len(found.events):9}")
    return took


def main() -> int:
    fitted, flown = drone(240.0, 1), drone(FULL_S + TIMED_S, 2)
    few = [c.path for c in flown.channels if c.sensor in FEW]
    describe_machine()
    print(f"\n{'us a sample':24}{'median':>9}{'mean':>9}{'p99':>9}{'worst ms':>9}{'replay':>9}{'events':>9}")
    bars = Bars()
    for bar, channels in ((BAR_US, [c.path for c in flown.channels]), (BAR_FEW_US, few)):
        name = f"{len(channels)} channels at {HZ:g} Hz"
        took = report(name, sf.fit(fitted.select(channels)), flown.select(channels))
        bars.check(f"{name}: {np.median(took):.1f} us, median; bar {bar:g}", bool(np.median(took) <= bar))
        bars.check(f"{name}: {took.mean():.1f} us, mean; bar {bar:g}", bool(took.mean() <= bar))
    return bars.exit_code()


if __name__ == "__main__":
    sys.exit(main())
