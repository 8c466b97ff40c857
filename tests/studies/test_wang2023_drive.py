"""Condition (a) on the real drive: the inertial unit beside the track, and what a seed changes."""

from pathlib import Path

import numpy as np
import pytest

from oracles.strapdown import navigate
from sensorfault.numerics.geodesy import ecef_to_geodetic, enu_axes
from sensorfault.simulation import pseudorange
from sensorfault.simulation.ride import Ride
from sensorfault_studies.wang2023.drive import drive, pseudoranges

pytestmark = pytest.mark.real


@pytest.fixture
def ride(real_data: Path, monkeypatch: pytest.MonkeyPatch) -> Ride:
    monkeypatch.setenv("SENSORFAULT_DATA", str(real_data))
    return drive("gaussian", 0)


def heading(one: Ride) -> np.ndarray:
    latitude, longitude, _ = ecef_to_geodetic(one.position)
    nose = np.einsum("tij,tj->ti", enu_axes(latitude, longitude), one.attitude[:, :, 0])
    return np.unwrap(np.arctan2(nose[:, 0], nose[:, 1]))


def test_the_unit_feels_the_track(ride: Ride) -> None:
    rate, force = ride.log.value[:, :3], ride.log.value[:, 3:6]
    # clockwise is positive about down; over seven minutes what a constant bias leaves is below a degree
    course, turned = heading(ride), np.cumsum(rate[:, 2]) / 100
    off = course - turned
    line = np.polyfit(ride.log.time, off, 1)
    assert abs(line[0]) < 0.004
    assert np.rad2deg(off - np.polyval(line, ride.log.time)).std() < 0.5
    assert np.ptp(course) > 2 * np.pi
    # time: turning and going fast the two agree best as they stand, to a tick or three
    speed = np.linalg.norm(ride.velocity, axis=1)
    fast = np.flatnonzero(speed[500:-500] > 5)[::10] + 500

    def miss(ticks: int) -> float:
        change = course[fast + 50] - course[fast - 50] - (turned[fast + 50 + ticks] - turned[fast - 50 + ticks])
        return float(np.median(np.abs(change - np.median(change))))

    assert abs(min(range(-30, 31), key=miss)) <= 3
    # forward (where slopes pull as well), right, down: what is felt goes with speed, with speed times turn rate, weight
    ahead, aside = np.gradient(speed, 0.01), speed * np.gradient(course, 0.01)
    seconds = np.arange(0, len(speed) - 100, 100)[:, None] + np.arange(100)
    mean = force[seconds].mean(axis=1)
    assert np.corrcoef(mean[:, 0], ahead[seconds].mean(axis=1))[0, 1] > 0.9
    assert np.corrcoef(mean[:, 1], aside[seconds].mean(axis=1))[0, 1] > 0.95
    assert force[:, 2].mean() == pytest.approx(-9.8, abs=0.15)


def test_ten_seconds_by_itself_stay_within_metres(ride: Ride) -> None:
    start = 11_000
    rows = slice(start, start + 1000)
    place, _, _ = navigate(
        ride.log.value[rows, :3] - [0, 0, -3e-3],
        ride.log.value[rows, 3:6],
        0.01,
        ride.position[start - 1],
        ride.velocity[start - 1],
        ride.attitude[start - 1],
    )
    away = np.linalg.norm(place[-1] - ride.position[start + 999])
    assert np.linalg.norm(ride.position[start + 999] - ride.position[start - 1]) > 60
    assert away < 25


def test_a_seed_draws_the_errors_and_nothing_else(ride: Ride) -> None:
    other = drive("gaussian", 1)
    assert len(ride.epochs) == 413
    assert len(ride.sky.names) == 9
    assert np.rad2deg(ride.sky.elevation).min() > 15
    np.testing.assert_array_equal(other.log.value[:, :6], ride.log.value[:, :6])
    at = [ride.log.index(f"{one}.corrected_m") for one in ride.sky.names]
    change = (other.log.value - ride.log.value)[ride.epochs][:, at]
    both = pseudoranges("gaussian", [0, 1])
    np.testing.assert_allclose(change, both[1] - both[0], atol=1e-7)
    assert (both / pseudorange.sigma(ride.sky.elevation)).std() == pytest.approx(1.0, abs=0.03)
    assert pseudoranges("heavy", range(50)).shape == (50, 413, 9)
