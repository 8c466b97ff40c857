"""A follower: which channels say where it and its leaders are, and how far away a leader is."""

from dataclasses import replace

import jax.numpy as jnp
import numpy as np
import pytest

import missions
from sensorfault.core.types import Sample
from sensorfault.logs.table import Channel, Sensor
from sensorfault.numerics.geodesy import geodetic_to_ecef
from sensorfault.runtime.runners import samples
from sensorfault.vehicles.underwater import Follower, FollowerRoles, Leader, roles


def test_roles_of_a_mission() -> None:
    found = roles(missions.healthy().log)
    assert found.leaders == (Leader(6, (7, 8), 9), Leader(10, (11, 12), 13))
    assert (found.position, found.velocity, found.heading, found.depth) == ((0, 1), (2, 3), 4, 5)
    assert found.geodetic


def test_roles_on_a_plane_without_a_log_of_speed() -> None:
    log = missions.healthy().log
    channels = (
        *(Channel(name, "tag", "m") for name in "xy"),
        *(Channel(name, "anchor", "cm" if name == "range" else "m") for name in ("x", "y", "range")),
    )
    sensors = Sensor("tag", 1.0), Sensor("anchor", 1.0)
    log = replace(log, value=log.value[:, :5], fresh=log.fresh[:, :5], channels=channels, sensors=sensors)
    found = roles(log)
    assert found.leaders == (Leader(4, (3, 2)),)
    assert found.position == (1, 0)
    assert not found.geodetic
    assert found.velocity == ()


def test_a_range_needs_a_place() -> None:
    log = missions.healthy().log.select(["gps.latitude", "gps.longitude", "leader1.range"])
    assert roles(log).leaders == ()


def _sample(value) -> Sample:
    there = np.ones((1, len(value)), bool)
    return Sample(*(x[0] for x in samples(np.zeros(1), np.asarray(value, float)[None], there)[:5]))


@pytest.mark.parametrize("latitude", [0.0, 45.0, -70.0])
def test_a_kilometre_is_one(latitude) -> None:
    """Absolute longitudes and radii, as (3) and (4) are printed, would make 563 m of 300 m to the north at 45 deg."""
    vehicle = Follower(jnp.ones(()), jnp.ones(()), FollowerRoles((Leader(0, (1, 2)),), (3, 4)))
    here = np.deg2rad([latitude, 126.0])
    for way in ([300.0, 0.0], [0.0, 300.0], [700.0, -700.0]):
        there = here + np.asarray(way) / np.asarray(vehicle._metres(jnp.asarray(here)))
        away = np.linalg.norm(geodetic_to_ecef(*there, 0.0) - geodetic_to_ecef(*here, 0.0))
        result = vehicle.expected(jnp.asarray(here), _sample([0.0, *there, 0.0, 0.0]))
        np.testing.assert_allclose(result, [away], rtol=1e-5)


def test_depths_count() -> None:
    found = FollowerRoles((Leader(0, (1, 2), 3),), (5, 6), depth=4, geodetic=False)
    vehicle = Follower(jnp.ones(()), jnp.ones(()), found)
    np.testing.assert_allclose(vehicle.expected(jnp.zeros(2), _sample([0, 3, 4, 22, 10, 0, 0])), [13.0])


def test_dead_reckoning_turns_with_the_heading() -> None:
    """(1): forward 2 m/s and 1 m/s to the right on a course of east by five seconds: 10 m east, 5 m south."""
    found = FollowerRoles((Leader(0, (1, 2)),), (3, 4), velocity=(5, 6), heading=7, geodetic=False)
    vehicle = Follower(jnp.ones(()), jnp.ones(()), found)
    sample = _sample([0, 0, 0, 0, 0, 2.0, 1.0, np.pi / 2])
    np.testing.assert_allclose(vehicle.ahead(jnp.zeros(2), sample, jnp.asarray(5.0)), [-5.0, 10.0], atol=1e-12)
