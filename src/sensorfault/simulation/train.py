"""A simulated train ride with an inertial unit and a satellite receiver."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.numerics.geodesy import enu_axes, enu_to_ecef
from sensorfault.numerics.gnss.constellation import walker
from sensorfault.simulation import imu, pseudorange, receiver_clock
from sensorfault.simulation.felt import felt
from sensorfault.simulation.imu import DEGREE, Grade
from sensorfault.simulation.motion import GRAVITY, Manner, Motion, integral, travel
from sensorfault.simulation.pseudorange import Noise
from sensorfault.simulation.ride import Ride, recorded
from sensorfault.simulation.sky import USED_ABOVE, Sky, overhead
from sensorfault.simulation.track import Track, line

# What cant and an unbalanced 0.65 m/s² allow together; trains start and brake at half of what cars do.
TRAIN = Manner(
    lateral=1.6,
    launch=0.5,
    brake=0.6,
    easing_s=3.0,
    wait_s=(25.0, 45.0),
    mood=(0.95, 0.02, 1000.0),
    roll_per_g=0.0,
    pitch_per_g=float(np.deg2rad(0.5)),
)
FASTEST = 40.0  # most distance in a second [m]


@dataclass(frozen=True)
class Unit:
    """An inertial unit: the grade of its gyros and of its accelerometers."""

    gyro: Grade
    accelerometer: Grade


# Gyro 0.1 °/√h and 1 °/h, accelerometer 50 µg/√Hz and 0.1 mg; turn-on bias 5 °/h and 1 mg.
TACTICAL = Unit(
    Grade(0.1 / 60 * DEGREE, 5 / 3600 * DEGREE, 1 / 3600 * DEGREE, 300.0, 1e-7, 400 * DEGREE),
    Grade(50e-6 * GRAVITY, 1e-3 * GRAVITY, 0.1e-3 * GRAVITY, 300.0, 1e-5, 10 * GRAVITY),
)
# Gyro 0.3 °/√h and 10 °/h, accelerometer 100 µg/√Hz and 0.2 mg; turn-on bias 0.1 °/s and 5 mg.
INDUSTRIAL = Unit(
    Grade(0.3 / 60 * DEGREE, 0.1 * DEGREE, 10 / 3600 * DEGREE, 300.0, 1e-6, 400 * DEGREE),
    Grade(100e-6 * GRAVITY, 5e-3 * GRAVITY, 0.2e-3 * GRAVITY, 300.0, 1e-4, 8 * GRAVITY),
)
"""Grades after Groves (2013), tables 4.1 and 4.3: tactical, and industrial MEMS."""


def ride(
    duration_s: float = 600.0,
    seed: int = 0,
    noise: Noise = "heavy",
    unit: Unit = INDUSTRIAL,
    imu_hz: int = 100,
    gps_s: float = 0.0,
    jump_s: float | None = None,
    origin_deg: tuple[float, float, float] = (52.45, 13.3, 80.0),
) -> Ride:
    """A ride from standstill with curves, stations, tunnels and cuttings at up to 140 km/h.

    Sensors: `gyro` and `accelerometer` (forward, right, down) at `imu_hz`, each row the mean since the one before; at
    1 Hz those of 36 satellites that are above ten degrees and not hidden by the ground beside the track. The railway
    lies on the plane that touches the earth at the start. The same seed gives the same ride; track, driving, sensors,
    clock and pseudoranges have separate random generators. There is no vibration.

    Args:
        duration_s: how long [s].
        seed: of all random numbers.
        noise: of the pseudoranges, "gaussian" or "heavy" (`pseudorange.errors`).
        unit: the inertial unit.
        imu_hz: its rate.
        gps_s: time of GPS at the start [s]; says where the satellites are.
        jump_s: when the receiver's clock jumps by a millisecond, or never.
        origin_deg: latitude, longitude [deg] and height [m] of the start.

    Raises:
        ValueError: shorter than two epochs.
    """
    if not duration_s >= 2:
        raise ValueError(f"A ride of {duration_s:g} s has fewer than two epochs; make it longer.")
    on_track, on_driving, on_gyro, on_force, on_clock = np.random.default_rng(seed).spawn(5)
    time = np.arange(round(duration_s * imu_hz)) / imu_hz
    track = line(max(FASTEST * duration_s, 4000.0), on_track)
    motion = travel(track.route, time, on_driving, TRAIN)
    gone = integral(motion.speed, 1 / imu_hz)
    cant = np.interp(gone, track.route.distance, track.cant)
    position, velocity, attitude = _in_ecef(motion, cant, origin_deg)
    rate, force = felt(position, velocity, attitude, 1 / imu_hz)
    said = (
        imu.measure(rate, imu_hz, unit.gyro, on_gyro),
        imu.measure(force, imu_hz, unit.accelerometer, on_force),
    )
    epochs = np.arange(0, len(time), imu_hz)
    sky = overhead(walker(), gps_s + time[epochs], position[epochs], velocity[epochs])
    seen = visible(sky, motion.heading[epochs], track, gone[epochs])
    ever = np.asarray(seen.any(axis=0))
    sky, seen = sky.only(ever), seen[:, ever]
    clock = receiver_clock.wander(on_clock, time, jump_s)
    error = np.where(seen, pseudorange.errors(noise, [seed], sky.elevation)[0], np.nan)
    rate_error = pseudorange.rate_errors([seed], sky.elevation)[0]
    name = f"train {noise} {seed}"
    log = recorded(name, time, np.concatenate(said, axis=1), epochs, sky, clock, error, rate_error)
    return Ride(log, position, velocity, attitude, clock, epochs, sky, error)


def visible(
    sky: Sky, heading: Float[np.ndarray, " E"], track: Track, gone: Float[np.ndarray, " E"]
) -> Bool[np.ndarray, "E S"]:
    """Which satellites are above the ground beside the track; none in a tunnel.

    Args:
        sky: at E epochs.
        heading: from east over north [rad].
        track: the track with the ground beside it.
        gone: distance of the train along the track [m].
    """
    along = np.searchsorted(track.route.distance, gone, side="right") - 1
    # how far to the right of the track's direction a satellite is, and how high the ground stands in that direction:
    # a wall at the side that is seen at θ square to the track is seen at tan el = tan θ |sin β| in direction β
    aside = np.sin(sky.azimuth - (np.pi / 2 - heading)[:, None])
    wall = np.where(aside > 0, track.right[along][:, None], track.left[along][:, None])
    ground = np.arctan(np.tan(wall) * np.abs(aside))
    above = sky.elevation > np.maximum(ground, USED_ABOVE)
    return np.asarray(above & ~track.tunnel[along][:, None])


def _in_ecef(
    m: Motion, cant: Float[np.ndarray, " T"], origin_deg: tuple[float, float, float]
) -> tuple[Float[np.ndarray, "T 3"], Float[np.ndarray, "T 3"], Float[np.ndarray, "T 3 3"]]:
    """Position, velocity and attitude (forward, right, down to ECEF) of a train that lies on its rails."""
    latitude, longitude = float(np.deg2rad(origin_deg[0])), float(np.deg2rad(origin_deg[1]))
    axes = enu_axes(latitude, longitude)
    c, s = np.cos(m.heading), np.sin(m.heading)
    cp, sp = np.cos(m.pitch), np.sin(m.pitch)
    forward = np.stack([c * cp, s * cp, -sp], axis=1)
    level = np.stack([s, -c, np.zeros_like(c)], axis=1)  # to the right
    under = np.cross(forward, level)
    cr, sr = np.cos(cant)[:, None], np.sin(cant)[:, None]
    # rolled to the right by the cant: the left rail is higher
    right, down = cr * level + sr * under, cr * under - sr * level
    attitude = axes.T @ np.stack([forward, right, down], axis=2)
    return enu_to_ecef(m.position, latitude, longitude, origin_deg[2]), m.velocity @ axes, attitude
