"""What must agree on average: the steering's zero on straights, airspeed over ground speed."""

from collections.abc import Iterator

import numpy as np

from sensorfault.relations.grid import Grid
from sensorfault.relations.levels.finding import Finding

AIR_SCALE = (0.7, 1.4)  # airspeed over ground speed, over all headings
STEER_ZERO_RAD = float(np.radians(1.5))
STRAIGHT_RAD_S, FAST_M_S, STEADY_RAD = 0.02, 5.0, float(np.radians(1.0))


def findings(grid: Grid, vehicle: str) -> Iterator[Finding]:
    """Of steering and airspeed."""
    yield from _steering(grid)
    yield from _airspeed(grid)


def _steering(grid: Grid) -> Iterator[Finding]:
    speed = next((key for key in ("wheel", "gnss.speed") if key in grid), None)
    if "steering" not in grid or "gyro" not in grid or speed is None:
        return
    rate = np.gradient(grid.integral("gyro")[:, 2], grid.time)
    straight = (np.abs(rate) < STRAIGHT_RAD_S) & (grid.value(speed)[:, 0] > FAST_M_S)
    angle = grid.value("steering")[:, 0][straight]
    if len(angle) < 40:
        return
    zero = float(np.median(angle))
    if abs(zero) > STEER_ZERO_RAD and np.median(np.abs(angle - zero)) < STEADY_RAD:
        when = grid.start_s, grid.end_s
        yield Finding("steering", *when, "angle on straights", zero, STEER_ZERO_RAD, "offset", lasting=True)


def _airspeed(grid: Grid) -> Iterator[Finding]:
    speed = next((key for key in ("gnss.speed", "gnss.velocity") if key in grid), None)
    if "airspeed" not in grid or speed is None:
        return
    ground = np.linalg.norm(grid.value(speed), axis=1)
    air = grid.value("airspeed")[:, 0]
    flying = np.isfinite(ground) & np.isfinite(air) & (ground > FAST_M_S)
    if flying.sum() < 300:
        return
    ratio = float(np.median(air[flying]) / np.median(ground[flying]))
    low, high = AIR_SCALE
    if not low < ratio < high:
        limit, when = (low if ratio < low else high), (grid.start_s, grid.end_s)
        yield Finding("airspeed", *when, "airspeed over ground speed", ratio, limit, "scale", lasting=True)
