"""What is learned of one vehicle before its sensors are compared: the gain and the zero of its steering."""

import numpy as np
from jaxtyping import Float

from sensorfault.relations.change import mean_of_last
from sensorfault.relations.grid import Grid
from sensorfault.relations.witnesses import MOVING_M_S, course, turned

STRAIGHT_RAD_S = 0.02
SMOOTH = 5  # ticks
Numbers = Float[np.ndarray, " T"]


def learned(grid: Grid) -> dict[str, float]:
    """Facts of a vehicle, from a piece of a log that is healthy for the most part."""
    return _steering(grid)


def _steering(grid: Grid) -> dict[str, float]:
    """yaw rate = gain * speed * (angle - zero), by gyro or by course: whichever fits better, as one may be wrong."""
    speed = next((key for key in ("wheel", "gnss.speed") if key in grid), None)
    if "steering" not in grid or speed is None:
        return {}
    angle, v = grid.value("steering")[:, 0], grid.value(speed)[:, 0]
    yaws = turned(2)(grid), course("gnss")(grid)
    found = (_fit(angle, v, np.gradient(yaw, grid.time)) for yaw in yaws if yaw is not None)
    fits = [fit for fit in found if fit is not None]
    if not fits:
        return {}
    _, gain, zero = min(fits)
    return {"steering.gain": gain, "steering.zero": zero}


def _fit(angle: Numbers, v: Numbers, rate: Numbers) -> tuple[float, float, float] | None:
    """Usual error [rad/s], gain and zero; medians, so that a fault of a part of the log has no say."""
    rate = mean_of_last(rate, SMOOTH)
    there = np.isfinite(angle) & np.isfinite(rate) & (v > MOVING_M_S)
    straight = there & (np.abs(rate) < STRAIGHT_RAD_S)
    if straight.sum() < 20:
        return None
    zero = float(np.median(angle[straight]))
    steer = v * (angle - zero)
    turning = there & (np.abs(steer) > np.quantile(np.abs(steer[there]), 0.7))
    if turning.sum() < 20:
        return None
    gain = float(np.median(rate[turning] / steer[turning]))
    return float(np.median(np.abs(rate[there] - gain * steer[there]))), gain, zero
