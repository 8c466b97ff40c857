"""A simulated drive through a town, for the demo, the tests, and whoever has no real log."""

from dataclasses import dataclass, replace

import numpy as np

from sensorfault.logs.table import Channel, Log, Sensor
from sensorfault.simulation import gnss, imu
from sensorfault.simulation.motion import Motion, travel
from sensorfault.simulation.route import town
from sensorfault.simulation.vibration import vibration

FASTEST = 18.0  # most distance in a second [m]
CHANNELS = (
    *(Channel(axis, "gyro", "deg/s") for axis in "xyz"),
    *(Channel(axis, "accelerometer", "m/s^2") for axis in "xyz"),
    Channel("latitude", "gnss", "deg", watch=False),
    Channel("longitude", "gnss", "deg", watch=False),
    Channel("altitude", "gnss", "m", watch=False),
    Channel("speed", "gnss", "km/h"),
    Channel("course", "gnss", "deg", watch=False),
)


@dataclass(frozen=True)
class Simulated:
    """The measurements and the truth.

    `truth` has the ticks and channels of `log` with the values of perfect sensors, new at each tick (true rates and
    forces include the vibration of the car); `motion` is the motion of the car.
    """

    log: Log
    truth: Log
    motion: Motion


def drive(
    duration_s: float = 600.0,
    seed: int = 0,
    imu_hz: float = 50.0,
    gnss_hz: float = 10.0,
    origin_deg: tuple[float, float, float] = (51.05, 13.74, 150.0),
) -> Simulated:
    """A drive from standstill with lights, corners, bends and roundabouts at up to 60 km/h.

    Sensors: `gyro` and `accelerometer` (x forward, y left, z up; consumer grade) at `imu_hz`, the clock of the log;
    `gnss` at `gnss_hz`, repeated between fixes. `origin_deg`: latitude, longitude [deg] and altitude [m] of the start.
    The same seed gives the same drive; motion, vibration and sensor errors have separate random generators.

    Raises:
        ValueError: a duration or rate that is too small or too large.
    """
    if not duration_s * imu_hz >= 2:
        raise ValueError(f"A drive of {duration_s:g} s at {imu_hz:g} Hz has fewer than two samples; make it longer.")
    if not 0 < gnss_hz <= imu_hz:
        raise ValueError(f"gnss_hz is {gnss_hz:g}; give a rate above 0 and up to that of the IMU, {imu_hz:g} Hz.")
    on_road, on_shaking, on_gyro, on_accelerometer, on_gnss = np.random.default_rng(seed).spawn(5)
    time = np.arange(round(duration_s * imu_hz)) / imu_hz
    motion = travel(town(max(FASTEST * duration_s, 500.0), on_road), time, on_road)

    shaking = vibration(motion.speed, imu_hz, on_shaking)
    rate = imu.angular_rate(motion) + shaking[:, :3]
    force = imu.specific_force(motion) + shaking[:, 3:]
    start = (float(np.deg2rad(origin_deg[0])), float(np.deg2rad(origin_deg[1])), origin_deg[2])
    fix, new_fix = gnss.receive(motion, start, gnss_hz, on_gnss)
    said = (
        imu.measure(rate, imu_hz, imu.CONSUMER_GYRO, on_gyro),
        imu.measure(force, imu_hz, imu.CONSUMER_ACCELEROMETER, on_accelerometer),
        fix,
    )
    fresh = np.ones((len(time), len(CHANNELS)), dtype=bool)
    fresh[:, 6:] = new_fix[:, None]
    log = Log(
        time=time,
        value=np.concatenate(said, axis=1),
        fresh=fresh,
        channels=CHANNELS,
        sensors=(
            Sensor("gyro", 1 / imu_hz),
            Sensor("accelerometer", 1 / imu_hz),
            Sensor("gnss", 1 / gnss_hz, held=True),
        ),
        name=f"drive {seed}",
    )
    true = np.concatenate((rate, force, gnss.ideal(motion, start)), axis=1)
    truth = replace(log, value=true, fresh=np.ones_like(fresh), name=f"drive {seed}, truth")
    return Simulated(log, truth, motion)
