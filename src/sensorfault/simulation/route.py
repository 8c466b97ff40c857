"""A random road through a town: curvature, slope, speed limit and places to stop, by distance."""

import math
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.simulation.noise import gauss_markov, smooth

STEP_M = 0.5
EASING_M = 10.0  # distance over which the steering wheel is turned
SLOPE_SD, SLOPE_LENGTH_M = 0.02, 200.0


@dataclass(frozen=True)
class Route:
    """M points, `STEP_M` apart. Left curves are positive, uphill slopes too."""

    distance: Float[np.ndarray, " M"]  # [m]
    curvature: Float[np.ndarray, " M"]  # [1/m]
    slope: Float[np.ndarray, " M"]  # dz/ds
    limit: Float[np.ndarray, " M"]  # [m/s]
    stop: Bool[np.ndarray, " M"]


@dataclass(frozen=True)
class _Piece:
    """A stretch of constant curvature; `stop`: the car stands at its end."""

    length_m: float
    curvature: float = 0.0
    stop: bool = False


def town(length_m: float, rng: np.random.Generator) -> Route:
    """Straights between bends, corners and roundabouts (driven on the right), some with a light before them."""
    pieces: list[tuple[_Piece, float]] = []
    while sum(piece.length_m for piece, _ in pieces) < length_m:
        limit = float(rng.choice((30, 50, 50, 60))) / 3.6
        light = bool(rng.random() < 0.4)
        straight = _Piece(float(rng.uniform(60, 350)), stop=light)
        pieces += [(piece, limit) for piece in (straight, *_junction(rng))]
    ends = np.cumsum([piece.length_m for piece, _ in pieces])
    s = np.arange(0.0, length_m, STEP_M)
    on = np.searchsorted(ends, s, side="right")
    stop = np.isin(np.arange(len(s)), np.ceil(ends[[piece.stop for piece, _ in pieces]] / STEP_M))
    stop[0] = True
    easing = int(EASING_M / STEP_M)
    curvature = np.array([piece.curvature for piece, _ in pieces])[on]
    slope = SLOPE_SD * gauss_markov(rng, len(s), STEP_M, SLOPE_LENGTH_M)
    return Route(
        distance=s,
        curvature=smooth(curvature, 2 * easing),
        slope=smooth(slope, 8 * easing),
        limit=np.array([limit for _, limit in pieces])[on],
        stop=stop,
    )


def _junction(rng: np.random.Generator) -> tuple[_Piece, ...]:
    """What follows a straight."""
    side = float(rng.choice((-1.0, 1.0)))
    kind = rng.choice(("corner", "bend", "roundabout", "crossing"), p=(0.5, 0.25, 0.1, 0.15))
    if kind == "corner":
        radius = rng.uniform(8, 18)
        return (_arc(radius, side * rng.uniform(65, 100)),)
    if kind == "bend":
        return (_arc(rng.uniform(50, 200), side * rng.uniform(15, 60)),)
    if kind == "roundabout":
        around = float(rng.choice((90.0, 180.0, 270.0)))
        return _arc(15.0, -45.0), _arc(14.0, around), _arc(15.0, -45.0)
    return ()


def _arc(radius_m: float, degrees: float) -> _Piece:
    turn = math.radians(degrees)
    return _Piece(radius_m * abs(turn), math.copysign(1 / radius_m, turn))
