"""Satellites overhead: geometry by hand, and rates against ranges a moment apart."""

import numpy as np
import pytest

from sensorfault.numerics.geodesy import enu_axes, geodetic_to_ecef
from sensorfault.numerics.gnss import kepler
from sensorfault.numerics.gnss.constellation import walker
from sensorfault.simulation.sky import overhead

C, EARTH = 299792458.0, 7.2921151467e-5
PLACE = geodetic_to_ecef(np.deg2rad(48.1), np.deg2rad(11.6), 500.0)
TIME = np.arange(0.0, 600.0, 60.0)


def still() -> np.ndarray:
    return np.repeat(PLACE[None], len(TIME), axis=0)


def test_signals_arrive_when_they_should() -> None:
    sky = overhead(walker(), TIME, still(), 0 * still())
    # In a frame that does not turn, aligned with the earth's at arrival: the satellite of t - ρ/c, turned on by Ω ρ/c.
    sent = TIME[:, None] - sky.range / C
    np.testing.assert_allclose(kepler.position(walker(), sent), sky.position, atol=1e-5)
    angle = EARTH * sky.range / C
    x, y, z = np.moveaxis(sky.position, 2, 0)
    turned = np.stack((x * np.cos(angle) + y * np.sin(angle), y * np.cos(angle) - x * np.sin(angle), z), axis=2)
    np.testing.assert_allclose(np.linalg.norm(turned - PLACE, axis=2), sky.range, atol=1e-5)
    up = enu_axes(np.deg2rad(48.1), np.deg2rad(11.6))[2]
    sine = ((sky.position - PLACE) @ up) / np.linalg.norm(sky.position - PLACE, axis=2)
    np.testing.assert_allclose(np.sin(sky.elevation), sine, atol=1e-12)
    assert (sky.elevation > 0.17).sum(axis=1).min() >= 8


def test_rates_are_of_ranges_of_one_who_moves() -> None:
    velocity = np.array([30.0, -20.0, 10.0])
    sky = overhead(walker(), TIME, still(), 0 * still() + velocity)
    near = [overhead(walker(), TIME + h, still() + h * velocity, 0 * still()).range for h in (-0.5, 0.5)]
    np.testing.assert_allclose(sky.rate, near[1] - near[0], atol=1e-3)


def test_only_some() -> None:
    sky = overhead(walker(), TIME, still(), 0 * still())
    kept = np.zeros(36, bool)
    kept[[4, 20]] = True
    some = sky.only(kept)
    assert some.names == ("G05", "G21")
    np.testing.assert_array_equal(some.position, sky.position[:, kept])
    assert some.azimuth == pytest.approx(sky.azimuth[:, [4, 20]])
