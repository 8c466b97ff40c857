"""A random railway: curves with transitions and cant, gradients, stations, and what hides the sky."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.simulation.noise import gauss_markov, smooth
from sensorfault.simulation.route import STEP_M, Route

CANT_PER_CURVATURE = 100.0  # [rad m]: a curve of 1000 m has 0.1 rad, 150 mm on standard gauge
MOST_CANT = 0.1  # [rad]
TRANSITION_M = 120.0  # curvature and cant grow over this
SLOPE_SD, SLOPE_LENGTH_M, MOST_SLOPE = 0.006, 1500.0, 0.0125
STATIONS_M, FIRST_M = (3000.0, 6000.0), 2500.0  # from one stop to the next, to the first
PLATFORM_M = 400.0
LIMITS_M_S = (80 / 3.6, 100 / 3.6, 120 / 3.6, 140 / 3.6)
TUNNELS_M, CUTTINGS_M, OPEN_M = (200.0, 900.0), (300.0, 1200.0), (500.0, 2500.0)
WALL = (float(np.deg2rad(20.0)), float(np.deg2rad(45.0)))  # elevation angle of the side of a cutting


@dataclass(frozen=True)
class Track:
    """M points `STEP_M` apart. `cant`: roll angle by which the left rail is higher [rad].

    `left`, `right`: elevation of the ground at right angles to the track [rad]; in a `tunnel` there is no sky.
    """

    route: Route
    cant: Float[np.ndarray, " M"]
    tunnel: Bool[np.ndarray, " M"]
    left: Float[np.ndarray, " M"]
    right: Float[np.ndarray, " M"]


def line(length_m: float, rng: np.random.Generator) -> Track:
    """Straights between curves of 600 to 2500 m, a stop each 3 to 6 km, tunnels and cuttings between open stretches."""
    on_curves, on_slope, on_stops, on_sky = rng.spawn(4)
    s = np.arange(0.0, length_m, STEP_M)
    curvature, limit = _curves(s, on_curves)
    slope = SLOPE_SD * gauss_markov(on_slope, len(s), STEP_M, SLOPE_LENGTH_M)
    stations = _stations(length_m, on_stops)
    stop = np.zeros(len(s), bool)
    stop[np.round(stations / STEP_M).astype(int)] = True
    tunnel, left, right = _sky(s, stations, on_sky)
    route = Route(
        distance=s,
        curvature=curvature,
        slope=smooth(np.clip(slope, -MOST_SLOPE, MOST_SLOPE), round(600.0 / STEP_M)),
        limit=limit,
        stop=stop,
    )
    # the outer rail is the higher one: in a curve to the left the right one
    cant = -np.clip(CANT_PER_CURVATURE * curvature, -MOST_CANT, MOST_CANT)
    return Track(route, cant, tunnel, left, right)


def _curves(
    s: Float[np.ndarray, " M"], rng: np.random.Generator
) -> tuple[Float[np.ndarray, " M"], Float[np.ndarray, " M"]]:
    """Curvature [1/m] and speed limit [m/s]: a straight and a curve in turn, one limit for both."""
    ends, curvature, limit = [0.0], [], []
    while ends[-1] < s[-1] + STEP_M:
        speed = float(rng.choice(LIMITS_M_S))
        radius = float(rng.uniform(600, 2500)) * float(rng.choice((-1.0, 1.0)))
        straight = float(rng.uniform(300, 1500))
        ends += [ends[-1] + straight, ends[-1] + straight + float(rng.uniform(300, 1000))]
        curvature += [0.0, 1 / radius]
        limit += [speed, speed]
    on = np.searchsorted(ends[1:], s, side="right")
    return smooth(np.array(curvature)[on], round(2 * TRANSITION_M / STEP_M)), np.array(limit)[on]


def _stations(length_m: float, rng: np.random.Generator) -> Float[np.ndarray, " n"]:
    """Where the train stops [m]: at the start, and at stations."""
    count = int(length_m / STATIONS_M[0]) + 1
    at = FIRST_M + np.cumsum(np.concatenate([[0.0], rng.uniform(*STATIONS_M, count)]))
    return np.concatenate([[0.0], at[at < length_m - STEP_M]])


def _sky(
    s: Float[np.ndarray, " M"], stations: Float[np.ndarray, " n"], rng: np.random.Generator
) -> tuple[Bool[np.ndarray, " M"], Float[np.ndarray, " M"], Float[np.ndarray, " M"]]:
    """Tunnels, and the elevation of the ground left and right; stations are in the open."""
    tunnel = np.zeros(len(s), bool)
    left, right = np.zeros((2, len(s)))
    at, kinds = float(rng.uniform(*OPEN_M)), list[str]()
    while at < s[-1]:
        kinds = kinds[1:] or list(rng.permutation(("tunnel", "left", "right", "both")))
        kind = kinds[0]
        end = at + float(rng.uniform(*(TUNNELS_M if kind == "tunnel" else CUTTINGS_M)))
        here = (s >= at) & (s < end)
        tunnel |= here & (kind == "tunnel")
        for side, names in ((left, ("left", "both")), (right, ("right", "both"))):
            wall = float(rng.uniform(*WALL))
            if kind in names:
                side[here] = wall
        at = end + float(rng.uniform(*OPEN_M))
    for station in stations:
        near = np.abs(s - station) < PLATFORM_M
        tunnel[near] = False
        left[near], right[near] = 0.0, 0.0
    return tunnel, left, right
