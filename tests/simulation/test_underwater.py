"""Missions under water: what is said agrees with what was so."""

import numpy as np
import pytest

from sensorfault.numerics.geodesy import geodetic_to_ecef
from sensorfault.simulation.acoustic import Ranging
from sensorfault.simulation.underwater import sail


def test_the_same_seed_is_the_same_mission() -> None:
    one, two, other = sail(100.0, 3), sail(100.0, 3), sail(100.0, 4)
    np.testing.assert_array_equal(one.log.value, two.log.value)
    assert not np.array_equal(one.truth.value, other.truth.value)


def test_true_ranges_are_distances_on_the_ellipsoid() -> None:
    truth = sail(300.0, 1).truth
    at = {name: truth.index(name) for name in ("leader1.range", "leader1.latitude", "leader1.depth", "pressure.depth")}
    leader, k = at["leader1.latitude"], np.arange(0, 300, 50)
    v = truth.value[k]
    follower = geodetic_to_ecef(v[:, 0], v[:, 1], -v[:, at["pressure.depth"]])
    beacon = geodetic_to_ecef(v[:, leader], v[:, leader + 1], -v[:, at["leader1.depth"]])
    np.testing.assert_allclose(v[:, at["leader1.range"]], np.linalg.norm(beacon - follower, axis=1), atol=0.05)


def test_leaders_take_turns() -> None:
    log = sail(1000.0, 2, Ranging(leaders=3, period_s=6.0, lost=0.1)).log
    ranges = [log.index(f"leader{j}.range") for j in (1, 2, 3)]
    received = log.fresh[:, ranges]
    assert (received.sum(axis=1) <= 1).all()
    assert (np.abs(received.sum(axis=0) - 150) < 20).all()
    assert np.isnan(log.value[:, ranges][~received]).all()


def test_noise_is_as_large_as_asked_and_echoes_are_long() -> None:
    mission = sail(3000.0, 5, Ranging(sigma_m=2.0, outliers=0.1, outlier_m=50.0))
    column = mission.log.index("leader1.range")
    received = mission.log.fresh[:, column]
    error = (mission.log.value - mission.truth.value)[received, column]
    assert 1.4826 * np.median(np.abs(error - np.median(error))) == pytest.approx(2.0, rel=0.25)
    assert error.max() > 25.0 > -error.min()


def test_gps_is_there_on_the_surface_only() -> None:
    log = sail(100.0, 0, surface_s=10.0).log
    assert log.fresh[:11, 0].all()
    assert not log.fresh[11:, 0].any()


def test_too_short() -> None:
    with pytest.raises(ValueError, match="make it longer"):
        sail(1.0)


def test_sound_faster_than_assumed_makes_ranges_short() -> None:
    mission = sail(2000.0, 6, Ranging(sigma_m=0.5, sound=1.05))
    column = mission.log.index("leader2.range")
    received = mission.log.fresh[:, column]
    result = mission.log.value[received, column] / mission.truth.value[received, column]
    assert result.mean() == pytest.approx(1 / 1.05, rel=1e-3)
