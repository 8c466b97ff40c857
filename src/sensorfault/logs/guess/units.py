"""Units from values, where the name has none. Each reason begins with how sure it is: "likely", or "a guess"."""

import numpy as np
from jaxtyping import Float

from sensorfault.logs.units import KNOT, STANDARD_GRAVITY

EARTH_RADIUS_M = 6_371_000.0
_TURN = {"rad": 2 * np.pi, "deg": 360.0}
_SPEEDS = {"m/s": 1.0, "km/h": 3.6, "kn": 1 / KNOT}
_FAST_RAD_S = 3.5  # a vehicle that turns faster than this one time in twenty does not exist; in deg/s it is common
_FAST_M_S = 45.0
_COUNTS_FROM = 50.0  # a vehicle does not accelerate so much for half of the time
_CERTAINLY = 3.0  # a value this far beyond what the other unit allows makes one likely


def acceleration_unit(value: Float[np.ndarray, "T C"]) -> tuple[str, str]:
    """By the usual length of the axes together: gravity is 1 g, 9.8 m/s^2 or 1000 mg."""
    whole = value[np.isfinite(value).all(axis=1)]
    # axes that never come in one row: the length of their usual values has to do
    length = float(
        np.median(np.linalg.norm(whole, axis=1)) if len(whole) else np.linalg.norm(np.nanmedian(value, axis=0))
    )
    for unit, gravity in (("m/s^2", STANDARD_GRAVITY), ("g", 1.0), ("mg", 1000.0)):
        if 0.8 < length / gravity < 1.25:
            return unit, f"likely: its usual length {length:.4g} is gravity in {unit}"
    if _are_counts(whole) and length > _COUNTS_FROM:
        return "", f"a guess: whole numbers of usual length {length:.4g}: raw counts, whose scale the log does not say"
    return "m/s^2", f"a guess: in no unit is its usual length {length:.4g} gravity"


def _are_counts(value: Float[np.ndarray, "T C"]) -> bool:
    """Whether all are whole numbers, as a converter gives them."""
    known = value[np.isfinite(value)]
    return len(known) > 0 and bool((known == np.round(known)).all())


def rate_unit(value: Float[np.ndarray, "T C"]) -> tuple[str, str]:
    """By size: vehicles do not turn at 200 deg/s for long."""
    known = value[np.isfinite(value).any(axis=1)]
    if _are_counts(known) and len(np.unique(known)) > 2 and np.nanmax(np.abs(known)) > 1:
        return "", "a guess: whole numbers: raw counts, whose scale the log does not say"
    fast = float(np.quantile(np.nanmax(np.abs(known), axis=1), 0.95))
    unit = "deg/s" if fast > _FAST_RAD_S else "rad/s"
    sure = "likely" if fast > _CERTAINLY * _FAST_RAD_S else "a guess"
    return unit, f"{sure}: its 95th percentile is {fast:.3g}; rad/s up to {_FAST_RAD_S:g}, else deg/s"


def angle_unit(value: Float[np.ndarray, " T"]) -> tuple[str, str]:
    """By the largest: more than one turn in rad is deg."""
    largest = float(np.nanmax(np.abs(value)))
    unit = "deg" if largest > _TURN["rad"] + 0.01 else "rad"
    sure = "likely" if largest > _CERTAINLY * _TURN["rad"] else "a guess"
    return unit, f"{sure}: its largest is {largest:.4g}; rad up to one turn, else deg"


def wraps(value: Float[np.ndarray, " T"], unit: str) -> bool:
    """Whether the angle jumps from one end of its range to the other."""
    step = np.abs(np.diff(value[np.isfinite(value)]))
    return bool(len(step)) and float(step.max()) > 0.8 * _TURN.get(unit, np.inf)


def position_unit(value: Float[np.ndarray, " T"]) -> tuple[str, str]:
    """Latitude or longitude by size: whole numbers of 1e-7 deg, else deg."""
    largest = float(np.nanmax(np.abs(value)))
    return (
        ("1e-7deg", "likely: too large for deg") if largest > 360 else ("deg", "likely: the usual unit of a position")
    )


def height_unit(value: Float[np.ndarray, " T"]) -> tuple[str, str]:
    """By size: no vehicle here is above 50 km."""
    largest = float(np.nanmax(np.abs(value)))
    return ("mm", "likely: too large for m") if largest > 50_000 else ("m", "a guess: the usual unit of a height")


def speed_unit(
    speed: Float[np.ndarray, " T"], time: Float[np.ndarray, " T"], place_rad: Float[np.ndarray, "T 2"] | None
) -> tuple[str, str]:
    """By how fast the position moves, or by size where there is no position.

    Args:
        speed: in the unit sought.
        time: [s].
        place_rad: latitude and longitude [rad], on the same rows, or None.
    """
    moved = None if place_rad is None else _moved_m_s(time, place_rad, speed)
    if moved is not None:
        ratio = moved
        unit = min(_SPEEDS, key=lambda name: abs(np.log(ratio / _SPEEDS[name])))
        if abs(np.log(ratio / _SPEEDS[unit])) < 0.2:
            return unit, f"likely: it is {ratio:.2f} times as fast as the position moves in m/s"
    largest = float(np.nanmax(np.abs(speed)))
    if largest > _FAST_M_S:
        return "km/h", f"a guess: its largest is {largest:.3g}, too fast for most vehicles in m/s"
    return "m/s", f"a guess: its largest is {largest:.3g}; check it against km/h"


def _moved_m_s(time: np.ndarray, place_rad: np.ndarray, speed: np.ndarray) -> float | None:
    """Speed in its own unit over the speed of the position over steps of 2 s; None if the vehicle hardly moves."""
    good = np.isfinite(place_rad).all(axis=1) & np.isfinite(speed)
    time, place_rad, speed = time[good], place_rad[good], speed[good]
    if len(time) < 3:
        return None
    later = np.searchsorted(time, time + 2.0)
    here = np.flatnonzero(later < len(time))
    there = later[here]
    north, east = (place_rad[there] - place_rad[here]).T
    metres = EARTH_RADIUS_M * np.hypot(north, east * np.cos(place_rad[here, 0]))
    moving = metres > 6.0
    if moving.sum() < 10:
        return None
    mean_speed = (speed[here] + speed[there]) / 2
    ratio = mean_speed[moving] * (time[there] - time[here])[moving] / metres[moving]
    middle = float(np.median(ratio))
    return middle if middle > 0 else None
