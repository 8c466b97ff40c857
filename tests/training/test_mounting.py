"""The mounting of an inertial unit, from simulated drives that were turned on purpose."""

from dataclasses import replace

import numpy as np
import pytest

from sensorfault.logs.table import Log, LogError
from sensorfault.simulation.road import drive
from sensorfault.training.mounting import fit_mounting
from sensorfault.vehicles.car import roles


def turned(log: Log, by: np.ndarray) -> Log:
    """The log of a unit mounted so that what was x, y, z is now by @ (x, y, z)."""
    value = log.value.copy()
    for columns in ([0, 1, 2], [3, 4, 5]):
        value[:, columns] = value[:, columns] @ by.T
    return replace(log, value=value)


@pytest.fixture(scope="module")
def log() -> Log:
    return drive(180.0, seed=3).log


def test_axes_signs_and_lags_of_a_turned_unit(log: Log) -> None:
    by, _ = np.linalg.qr(np.random.default_rng(1).normal(size=(3, 3)))
    by = by * np.linalg.det(by)  # a rotation, not a mirror
    found = fit_mounting(turned(log, by), roles(log))
    assert found.up @ by[:, 2] > 0.995
    assert found.forward @ by[:, 0] > 0.98
    assert abs(found.forward @ found.up) < 1e-9
    assert found.yaw_sign == -1.0
    assert found.course_lag_s == pytest.approx(0.5, abs=0.15)  # the simulated receiver's
    assert found.speed_lag_s == pytest.approx(0.0, abs=0.15)


def test_a_gyro_of_the_other_hand_is_noticed(log: Log) -> None:
    value = log.value.copy()
    value[:, :3] *= -1
    found, right = fit_mounting(replace(log, value=value), roles(log)), fit_mounting(log, roles(log))
    assert found.yaw_sign == 1.0
    np.testing.assert_allclose(found.gyro_bias, -right.gyro_bias, atol=1e-12)


def test_the_yaw_bias_is_the_gyros(log: Log) -> None:
    value = log.value.copy()
    value[:, 2] += 0.02
    found, right = fit_mounting(replace(log, value=value), roles(log)), fit_mounting(log, roles(log))
    assert (found.gyro_bias - right.gyro_bias)[2] == pytest.approx(0.02, abs=1e-3)


def test_holes_in_the_log_are_bridged(log: Log) -> None:
    value, fresh = log.value.copy(), log.fresh.copy()
    value[1000:1100, :6], fresh[1000:1100, :6] = np.nan, False
    found = fit_mounting(replace(log, value=value, fresh=fresh), roles(log))
    assert found.up @ np.array([0.0, 0.0, 1.0]) > 0.995


def test_what_cannot_be_told_is_said(log: Log) -> None:
    bare = log.select(["gnss.speed", "gnss.course", "gyro.x", "gyro.y", "gyro.z"])
    with pytest.raises(LogError, match="no accelerometer"):
        fit_mounting(bare, roles(bare))
    value = log.value.copy()
    value[:, log.index("gnss.speed")] = 0.0
    with pytest.raises(LogError, match="give a drive that moves"):
        fit_mounting(replace(log, value=value), roles(log))
    value[:, log.index("gnss.speed")] = 10.0
    with pytest.raises(LogError, match="hardly changes its speed"):
        fit_mounting(replace(log, value=value), roles(log))
