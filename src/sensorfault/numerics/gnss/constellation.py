"""A constellation for simulations: satellites evenly spaced on circular orbits like those of GPS."""

from typing import Any

import numpy as np
from jaxtyping import Float

from sensorfault.numerics.gnss.constants import EARTH_MU, EARTH_RATE
from sensorfault.numerics.gnss.kepler import Ephemeris

_RADIUS_M = 26_559_700.0  # semi-major axis of GPS: two turns a sidereal day


def walker(
    satellites: int = 36,
    planes: int = 6,
    phasing: int = 1,
    inclination: float = float(np.deg2rad(55.0)),
    radius: float = _RADIUS_M,
    toe: float = 0.0,
) -> Ephemeris:
    """A Walker constellation i: T/P/F as ephemerides of shape (satellites,) with perfect clocks.

    Args:
        satellites: T, a multiple of `planes`.
        planes: P, their nodes evenly around the equator.
        phasing: F: a satellite is ahead of its neighbour in the plane to the west by F / T of a turn.
        inclination: i [rad].
        radius: of the circles [m].
        toe: reference time, seconds of GPS time; the first node is at longitude 0 then.

    Source: J. G. Walker, Satellite constellations, J. Brit. Interplanetary Soc. 37 (1984).
    """
    if satellites % planes:
        raise ValueError(f"{satellites} satellites do not fall evenly into {planes} planes; take a multiple.")
    plane, seat = np.divmod(np.arange(satellites), satellites // planes)
    zero: Float[Any, " T"] = np.zeros(satellites)
    # M = 2π (seat / S + F plane / T),  Ω = 2π plane / P
    anomaly = 2 * np.pi * (seat * planes / satellites + phasing * plane / satellites)
    fixed = dict.fromkeys(Ephemeris._fields, zero)
    return Ephemeris(**fixed)._replace(
        toe=zero + toe,
        toc=zero + toe,
        sqrt_a=zero + np.sqrt(radius),
        anomaly=anomaly,
        node=2 * np.pi * plane / planes,
        inclination=zero + inclination,
        mu=zero + EARTH_MU["G"],
        earth_rate=zero + EARTH_RATE["G"],
    )
