"""A simulated flight of a flapping-wing aircraft; with a beat of 0 Hz, of a fixed-wing one."""

from dataclasses import replace

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.logs.table import Channel, Log, Sensor
from sensorfault.numerics.geodesy import ecef_to_geodetic, enu_to_ecef
from sensorfault.simulation import gnss, imu
from sensorfault.simulation.motion import Motion
from sensorfault.simulation.noise import gauss_markov
from sensorfault.simulation.road import Simulated
from sensorfault.simulation.soaring import Flight, soar
from sensorfault.simulation.wing_beat import WingBeat, wing_beat

WEATHER_SD, WEATHER_S = 1.0, 300.0  # error of a barometer that wanders [m]
PRESSURE_WHITE, PRESSURE_LAG_S, PRESSURE_COUNT = 0.2, 0.2, 0.01  # ... that does not; its lag; one count [m]
VELOCITY_SD = np.array([0.08, 0.08, 0.12])  # of the receiver, north, east, down [m/s]
LEVEL_SD, LEVEL_S = np.deg2rad(0.7), 60.0  # error of the attitude
PITOT_SD = 0.3  # [m/s]
CHANNELS = (
    *(Channel(axis, "gyro", "deg/s") for axis in "xyz"),
    *(Channel(axis, "accelerometer", "m/s^2") for axis in "xyz"),
    Channel("latitude", "gnss", "deg", watch=False),
    Channel("longitude", "gnss", "deg", watch=False),
    Channel("altitude", "gnss", "m", watch=False),
    *(Channel(axis, "gnss", "m/s") for axis in ("north", "east", "down")),
    Channel("altitude", "barometer", "m", watch=False),
    Channel("roll", "attitude", "deg"),
    Channel("pitch", "attitude", "deg"),
    Channel("yaw", "attitude", "deg", watch=False),
    Channel("elevator", "control"),
    Channel("throttle", "control"),
    Channel("airspeed", "airspeed", "m/s"),
)


def fly(
    duration_s: float = 600.0,
    seed: int = 0,
    beat_hz: float = 6.0,
    imu_hz: float = 50.0,
    gnss_hz: float = 5.0,
    barometer_hz: float = 10.0,
    origin_deg: tuple[float, float, float] = (34.23, 108.91, 400.0),
) -> Simulated:
    """A flight at about 60 m height that climbs, descends and turns, without take-off and landing.

    Sensors: `gyro`, `accelerometer` (x forward, y left, z up; consumer grade), `attitude` (pitch: nose up), `control`
    and `airspeed` at `imu_hz`, the clock of the log; `gnss` and `barometer` at their own rates, repeated between
    measurements. The wing beat shakes gyro, accelerometer and barometer. The same seed gives the same flight.

    Raises:
        ValueError: a duration or rate that is too small or too large.
    """
    if not duration_s * imu_hz >= 2:
        raise ValueError(f"A flight of {duration_s:g} s at {imu_hz:g} Hz has fewer than two samples; make it longer.")
    for name, rate in (("gnss_hz", gnss_hz), ("barometer_hz", barometer_hz)):
        if not 0 < rate <= imu_hz:
            raise ValueError(f"{name} is {rate:g}; give a rate above 0 and up to that of the IMU, {imu_hz:g} Hz.")
    if not 0 <= beat_hz < imu_hz / 2:
        raise ValueError(f"beat_hz is {beat_hz:g}; give 0 for fixed wings, or a beat below {imu_hz / 2:g} Hz.")
    on_flight, on_beat, on_imu, on_gnss, on_rest = np.random.default_rng(seed).spawn(5)
    time = np.arange(round(duration_s * imu_hz)) / imu_hz
    flight = soar(time, on_flight)
    beat = wing_beat(time, flight.throttle, beat_hz, on_beat)
    start = (float(np.deg2rad(origin_deg[0])), float(np.deg2rad(origin_deg[1])), origin_deg[2])

    true = _truth(flight, beat, start)
    new_fix, new_pressure = gnss.due(time, gnss_hz), gnss.due(time, barometer_hz)
    said = np.concatenate(
        [
            imu.measure(true[:, :3], imu_hz, imu.CONSUMER_GYRO, on_imu),
            imu.measure(true[:, 3:6], imu_hz, imu.CONSUMER_ACCELEROMETER, on_imu),
            _held(_fix(flight.motion, start, new_fix, on_gnss), new_fix),
            _held(_pressure(flight.motion, beat, start[2], new_pressure, on_rest), new_pressure),
            _rest(true[:, 13:], imu_hz, on_rest),
        ],
        axis=1,
    )
    fresh = np.ones(said.shape, bool)
    fresh[:, 6:12], fresh[:, 12] = new_fix[:, None], new_pressure
    period = {"gnss": 1 / gnss_hz, "barometer": 1 / barometer_hz}
    names = dict.fromkeys(channel.sensor for channel in CHANNELS)
    sensors = tuple(Sensor(name, period.get(name, 1 / imu_hz), held=name in period) for name in names)
    log = Log(time, said, fresh, CHANNELS, sensors, f"flight {seed}")
    truth = replace(log, value=true, fresh=np.ones_like(fresh), name=f"flight {seed}, truth")
    return Simulated(log, truth, flight.motion)


def _truth(flight: Flight, beat: WingBeat, start: tuple[float, float, float]) -> Float[np.ndarray, "T 19"]:
    """The values of perfect sensors; rates and forces include the beat, heights do not."""
    m = flight.motion
    angles = np.stack([-m.roll, -m.pitch, np.mod(np.pi / 2 - m.heading, 2 * np.pi)], axis=1)
    return np.concatenate(
        [
            imu.angular_rate(m) + beat.rate,
            imu.specific_force(m) + beat.force,
            _place(m.position, m.velocity, start),
            (start[2] + m.position[:, 2])[:, None],
            angles,
            np.stack([flight.elevator, flight.throttle, np.linalg.norm(m.velocity, axis=1)], axis=1),
        ],
        axis=1,
    )


def _place(
    position: Float[np.ndarray, "n 3"], velocity: Float[np.ndarray, "n 3"], start: tuple[float, float, float]
) -> Float[np.ndarray, "n 6"]:
    """Latitude, longitude [rad], altitude [m], velocity north, east, down [m/s]."""
    east, north, up = velocity.T
    return np.stack([*ecef_to_geodetic(enu_to_ecef(position, *start)), north, east, -up], axis=1)


def _fix(
    m: Motion, start: tuple[float, float, float], new: Bool[np.ndarray, " T"], rng: np.random.Generator
) -> Float[np.ndarray, "n 6"]:
    at = np.flatnonzero(new)
    step = float(np.median(np.diff(m.time[at]))) if len(at) > 1 else 1.0
    wander = np.stack([gauss_markov(rng, len(at), step, gnss.POSITION_S) for _ in range(3)], axis=1)
    white = gnss.POSITION_WHITE * rng.standard_normal((len(at), 3))
    fix = _place(m.position[at] + gnss.POSITION_SD * wander + white, m.velocity[at], start)
    fix[:, 3:] += VELOCITY_SD * rng.standard_normal((len(at), 3))
    return fix


def _pressure(
    m: Motion, beat: WingBeat, origin_m: float, new: Bool[np.ndarray, " T"], rng: np.random.Generator
) -> Float[np.ndarray, "n 1"]:
    at = np.flatnonzero(new)
    step = float(np.median(np.diff(m.time[at]))) if len(at) > 1 else 1.0
    late = np.interp(m.time[at] - PRESSURE_LAG_S, m.time, m.position[:, 2])
    error = WEATHER_SD * gauss_markov(rng, len(at), step, WEATHER_S) + PRESSURE_WHITE * rng.standard_normal(len(at))
    height = origin_m + late + error + beat.height[at]
    return np.asarray(np.round(height / PRESSURE_COUNT) * PRESSURE_COUNT)[:, None]


def _rest(true: Float[np.ndarray, "T 6"], rate_hz: float, rng: np.random.Generator) -> Float[np.ndarray, "T 6"]:
    """Attitude with a drifting error, exact commands, and airspeed with noise."""
    n = len(true)
    wander = np.stack([gauss_markov(rng, n, 1 / rate_hz, LEVEL_S) for _ in range(3)], axis=1)
    error = np.column_stack([LEVEL_SD * wander, np.zeros((n, 2)), PITOT_SD * rng.standard_normal(n)])
    return np.asarray(true + error)


def _held(rows: Float[np.ndarray, "n k"], new: Bool[np.ndarray, " T"]) -> Float[np.ndarray, "T k"]:
    """Repeat each row until the next."""
    row: Float[np.ndarray, "T k"] = rows[np.cumsum(new) - 1]
    return row
