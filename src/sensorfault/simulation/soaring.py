"""Climbs and descents of an aircraft: heights that a pilot might choose, and the controls to reach them."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from sensorfault.simulation.motion import GRAVITY, Motion
from sensorfault.simulation.noise import gauss_markov, smooth

HEIGHT, HEIGHT_SD, HEIGHT_S = 60.0, 20.0, 60.0  # above the start [m], and for how long one is kept [s]
EASING_S = 16.0  # a change of height begins and ends within about this time
SPEED, SPEED_SD, SPEED_S = 8.0, 0.6, 20.0  # airspeed; there is no wind [m/s]
TURN_SD, TURN_S = 0.15, 12.0  # of the heading [rad/s]
EDGE_S = 2.0
RESPONSE_S = 1.5  # lag of the climb behind throttle and elevator
PITCH, PITCH_PER_CLIMB = 0.08, 0.09  # nose up in level flight [rad], and more of it for each m/s to climb
HOVER, THROTTLE_PER_CLIMB = 0.5, 0.12  # throttle in level flight, and more of it for each m/s


@dataclass(frozen=True)
class Flight:
    """The motion and the pilot's controls: throttle (0 to 1) and elevator (-1 to 1)."""

    motion: Motion
    throttle: Float[np.ndarray, " T"]
    elevator: Float[np.ndarray, " T"]


def soar(time: Float[np.ndarray, " T"], rng: np.random.Generator) -> Flight:
    """A flight in still air, already aloft. Turns are flown coordinated."""
    step = float(time[1] - time[0])
    edge = round(EDGE_S / step)  # flown, then cut off: there is no derivative at the ends
    n = len(time) + 2 * edge
    wander = smooth(gauss_markov(rng, n, step, HEIGHT_S), round(EASING_S / step))
    up = HEIGHT + HEIGHT_SD * wander
    climb = np.gradient(up, step)
    # climb' = (command - climb) / RESPONSE_S
    command = climb + RESPONSE_S * np.gradient(climb, step)
    eased = round(2.0 / step)
    speed = SPEED + SPEED_SD * smooth(gauss_markov(rng, n, step, SPEED_S), eased)
    turn = TURN_SD * smooth(gauss_markov(rng, n, step, TURN_S), eased)
    heading = rng.uniform(0, 2 * np.pi) + np.cumsum(turn) * step
    pitch_up = PITCH + PITCH_PER_CLIMB * command
    level = np.sqrt(np.maximum(speed**2 - climb**2, 1.0))
    velocity = np.stack([level * np.cos(heading), level * np.sin(heading), climb], axis=1)
    east_north = np.cumsum(velocity[:, :2], axis=0) * step
    acceleration = np.stack([np.gradient(level, step), level * turn, np.gradient(climb, step)], axis=1)
    trimmed = pitch_up + np.gradient(pitch_up, step)
    kept = slice(edge, edge + len(time))
    position = np.column_stack([east_north, up])[kept]
    motion = Motion(
        time=time,
        position=position - position[0],
        velocity=velocity[kept],
        speed=level[kept],
        acceleration=acceleration[kept],
        roll=-np.arctan(level * turn / GRAVITY)[kept],
        pitch=-pitch_up[kept],
        heading=heading[kept],
    )
    throttle = np.clip(HOVER + THROTTLE_PER_CLIMB * command, 0, 1)
    return Flight(motion, throttle[kept], np.clip(trimmed, -1, 1)[kept])
