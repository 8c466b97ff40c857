"""A car that leaves its model: every sensor that feels it agrees with the others about where it went."""

from dataclasses import replace

import numpy as np
import pytest

from sensorfault.faults.fault import FaultError
from sensorfault.faults.motion import Felt, MotionFault, move
from sensorfault.logs.table import Log
from sensorfault.numerics.geodesy import SEMI_MAJOR_AXIS
from sensorfault.simulation.road import drive

FELT = Felt((6, 7), (9, 10), True, (3, 4, 5), (0, 1, 2))


def a_log() -> Log:
    return drive(60.0, seed=3).log


def north_east(log: Log) -> np.ndarray:
    """Metres."""
    latitude, longitude = log.value[:, 6], log.value[:, 7]
    return SEMI_MAJOR_AXIS * np.stack([latitude, longitude * np.cos(latitude[0])], axis=1)


def velocity(log: Log) -> np.ndarray:
    speed, course = log.value[:, 9], log.value[:, 10]
    return np.stack([speed * np.cos(course), speed * np.sin(course)], axis=1)


def test_a_side_slip_is_felt_by_all_alike() -> None:
    log = a_log()
    fault = MotionFault("side slip", 30.0, 3.0, 2.0)
    slipped = move(log, fault, FELT)
    way, pace = north_east(slipped) - north_east(log), velocity(slipped) - velocity(log)
    before, after = log.time < 30.0, log.time > 33.2
    assert not way[before].any()
    assert not pace[before | after].any()
    course = log.value[:, 10]
    left = np.stack([np.sin(course), -np.cos(course)], axis=1)
    inside = (log.time > 30.7) & (log.time < 32.3)
    np.testing.assert_allclose((pace * left).sum(axis=1)[inside], 2.0, atol=0.1)
    # the way is the integral of the pace, and the force to the left that of its change
    walked = np.cumsum(pace * np.diff(log.time, prepend=0.0)[:, None], axis=0)[-1]
    np.testing.assert_allclose(way[-1], walked, rtol=0.05, atol=0.15)
    pushed = slipped.value[:, 3:6] - log.value[:, 3:6]
    assert np.abs(pushed[:, [0, 2]]).max() == 0
    assert np.abs(np.cumsum(pushed[:, 1]) * 0.02)[inside].mean() == pytest.approx(2.0, rel=0.02)
    np.testing.assert_array_equal(slipped.value[:, :3], log.value[:, :3])  # it does not turn


def test_held_fixes_stay_held() -> None:
    log = a_log()
    slipped = move(log, MotionFault("side slip", 30.0, 3.0, 2.0), FELT)
    held = ~log.fresh[1:, 6]
    np.testing.assert_array_equal(slipped.value[1:, 6:][held], slipped.value[:-1, 6:][held])


def test_a_spin_turns_the_car_and_not_its_way() -> None:
    log = a_log()
    spun = move(log, MotionFault("spin", 30.0, 2.0, 0.8), FELT)
    turned = ((spun.value - log.value)[:, 2] * np.gradient(log.time)).sum()
    assert turned == pytest.approx(0.8, rel=1e-3)
    np.testing.assert_array_equal(spun.value[:, 6:], log.value[:, 6:])
    size = np.hypot(*log.value[:, 3:5].T)
    np.testing.assert_allclose(np.hypot(*spun.value[:, 3:5].T), size, atol=1e-9)


def test_wheels_slip_where_wheels_are_heard() -> None:
    log = a_log()
    slipped = move(log, MotionFault("wheel slip", 30.0, 2.0, 1.3), replace(FELT, wheels=(9,)))
    inside = (log.time >= 30.0) & (log.time < 32.0)
    np.testing.assert_allclose(slipped.value[inside, 9], 1.3 * log.value[inside, 9])
    np.testing.assert_array_equal(slipped.value[~inside], log.value[~inside])


@pytest.mark.parametrize(
    ("fault", "said"),
    [
        (MotionFault("flight", 30.0, 2.0, 1.0), "no motion is called 'flight'"),
        (MotionFault("side slip", 59.0, 2.0, 1.0), "outside the log"),
        (MotionFault("wheel slip", 30.0, 2.0, 1.0), "no wheel speed"),
    ],
)
def test_what_cannot_be_done_is_said(fault: MotionFault, said: str) -> None:
    with pytest.raises(FaultError, match=said):
        move(a_log(), fault, FELT)


def test_no_gyro_no_spin() -> None:
    with pytest.raises(FaultError, match="no gyro"):
        move(a_log(), MotionFault("spin", 30.0, 2.0, 1.0), replace(FELT, gyro=None))
