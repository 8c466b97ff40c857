"""How a driver follows a route: speed over time, and the motion of the car."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from sensorfault.simulation.noise import gauss_markov, smooth
from sensorfault.simulation.route import STEP_M, Route

GRAVITY = 9.81  # [m/s^2]


@dataclass(frozen=True)
class Manner:
    """How a vehicle is driven, and how it leans on its springs; the defaults are those of a car in a town."""

    lateral: float = 2.8  # comfortable acceleration to the side [m/s^2]
    launch: float = 1.6  # comfortable acceleration [m/s^2]
    brake: float = 1.9  # comfortable deceleration [m/s^2]
    easing_s: float = 1.6  # time to press a pedal: jerk stays below 5 m/s^3
    wait_s: tuple[float, float] = (5.0, 30.0)  # at a light
    mood: tuple[float, float, float] = (0.92, 0.06, 80.0)  # speed over limit: mean, standard deviation, length [m]
    roll_per_g: float = float(np.deg2rad(4.0))
    pitch_per_g: float = float(np.deg2rad(3.0))


CAR = Manner()


@dataclass(frozen=True)
class Motion:
    """The truth at T ticks. Local frame: east, north, up; heading counts from east towards north (anticlockwise).

    Roll is positive when the left side is up, pitch when the nose is down (axes x forward, y left, z up).
    """

    time: Float[np.ndarray, " T"]  # [s]
    position: Float[np.ndarray, "T 3"]  # east, north, up of the start [m]
    velocity: Float[np.ndarray, "T 3"]  # [m/s]
    speed: Float[np.ndarray, " T"]  # along the road [m/s]
    acceleration: Float[np.ndarray, "T 3"]  # forward and left on the level, up [m/s^2]
    roll: Float[np.ndarray, " T"]  # [rad]
    pitch: Float[np.ndarray, " T"]  # [rad]
    heading: Float[np.ndarray, " T"]  # [rad], not wrapped


def speed_limit(route: Route, rng: np.random.Generator, manner: Manner = CAR) -> Float[np.ndarray, " M"]:
    """Speed at each point of the route [m/s]: the highest that limit, curves and comfort allow, 0 at stops."""
    mean, spread, length_m = manner.mood
    mood = mean + spread * gauss_markov(rng, len(route.distance), STEP_M, length_m)
    # v² κ ≤ lateral
    curve = manner.lateral / np.maximum(np.abs(route.curvature), 1e-6)
    most = np.where(route.stop, 0.0, np.minimum((route.limit * mood) ** 2, curve))
    # v²(s) = min over earlier s' of most(s') + 2 a (s - s'), and from behind the same with the brakes
    reach = 2 * manner.launch * route.distance
    most = np.minimum.accumulate(most - reach) + reach
    reach = 2 * manner.brake * route.distance
    most = np.maximum(np.minimum.accumulate((most + reach)[::-1])[::-1] - reach, 0.0)
    most[route.stop] = 0.0  # exactly
    return np.asarray(np.sqrt(most))


def travel(route: Route, time: Float[np.ndarray, " T"], rng: np.random.Generator, manner: Manner = CAR) -> Motion:
    """Drive the route from standstill; `time` [s] is even and starts at 0."""
    dt = float(time[1] - time[0])
    v = speed_limit(route, rng, manner)
    # Constant acceleration over a step: Δt = 2 Δs / (v + v⁺); a stop lasts from its arrival to its leaving.
    arrival = np.concatenate(([0.0], np.cumsum(2 * STEP_M / (v[1:] + v[:-1]))))
    wait = np.where(route.stop, rng.uniform(*manner.wait_s, len(v)), 0.0)
    leaving = arrival + np.cumsum(wait)
    clock = np.stack((leaving - wait, leaving), axis=1).ravel()
    speed = smooth(np.interp(time, clock, np.repeat(v, 2)), round(2 * manner.easing_s / dt))
    distance = integral(speed, dt)

    def along(x: Float[np.ndarray, " M"]) -> Float[np.ndarray, " T"]:
        return np.asarray(np.interp(distance, route.distance, x))

    # ψ' = v κ
    yaw_rate = speed * along(route.curvature)
    heading = integral(yaw_rate, dt)
    climb = along(np.arctan(route.slope))
    level, rise = speed * np.cos(climb), speed * np.sin(climb)
    velocity = np.stack((level * np.cos(heading), level * np.sin(heading), rise), axis=1)
    forward, left, up = np.gradient(level, dt), level * yaw_rate, np.gradient(rise, dt)
    return Motion(
        time=time,
        position=integral(velocity, dt),
        velocity=velocity,
        speed=speed,
        acceleration=np.stack((forward, left, up), axis=1),
        roll=manner.roll_per_g * left / GRAVITY,
        pitch=-manner.pitch_per_g * forward / GRAVITY - climb,
        heading=heading,
    )


def integral(x: Float[np.ndarray, "T *n"], step: float) -> Float[np.ndarray, "T *n"]:
    """Integral by the trapezoidal rule, 0 at the first row."""
    return np.concatenate((np.zeros_like(x[:1]), np.cumsum((x[1:] + x[:-1]) * step / 2, axis=0)))
