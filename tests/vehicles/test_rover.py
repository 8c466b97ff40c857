"""A robot that counts its wheels' turns, against the same reckoning in a NumPy loop; and through a filter."""

import jax.numpy as jnp
import numpy as np
import pytest

from sensorfault.core.types import Sample
from sensorfault.runtime.runners import samples
from sensorfault.vehicles.rover import UNKNOWN_SPEED, UNKNOWN_TURN, Rover

LANDMARKS = np.array([[4.0, 1.0], [-2.0, 5.0], [0.5, -3.0]])
Q = np.array([1e-3, 2e-3, 3e-3])
ROVER = Rover(
    landmarks=jnp.asarray(LANDMARKS),
    q=jnp.asarray(Q),
    first=jnp.asarray([0.1, 0.2, 0.3]),
    observed=(5, 6, 7),
    odometry=(3, 4),
    pose=(0, 1, 2),
)


def sample(forward: float = np.nan, turn: float = np.nan, pose: tuple[float, ...] = (np.nan,) * 3) -> Sample:
    value = np.array([[*pose, forward, turn, 1.0, 2.0, 3.0]])
    return Sample(*(x[0] for x in samples(np.zeros(1), value, np.isfinite(value))[:-1]))


def test_the_way_is_that_of_many_small_steps() -> None:
    v, w, dt = 0.4, 0.3, 0.5
    state = np.array([1.0, 2.0, 0.7])
    for _ in range(8):
        slow = state.copy()
        for _ in range(1000):
            slow += dt / 1000 * np.array([v * np.cos(slow[2]), v * np.sin(slow[2]), w])
        state = np.asarray(ROVER.ahead(jnp.asarray(state), sample(v, w), jnp.asarray(dt)))
        # the middle of an arc of 0.15 rad: v dt (1 - sin(a) / a), a half the turn
        np.testing.assert_allclose(state, slow, atol=v * dt * 0.075**2 / 6 + 1e-4)
        state = slow


@pytest.mark.parametrize(("forward", "turn"), [(0.4, 0.3), (np.nan, 0.3), (0.4, np.nan), (np.nan, np.nan)])
def test_what_no_wheel_says_is_uncertain_and_no_motion(forward: float, turn: float) -> None:
    now, dt = sample(forward, turn), 2.0
    spread = np.asarray(ROVER.noise(jnp.zeros(3), jnp.zeros(3), now, jnp.asarray(dt)))
    own = np.array([UNKNOWN_SPEED, UNKNOWN_SPEED, UNKNOWN_TURN]) * np.isnan([forward, forward, turn])
    np.testing.assert_allclose(spread, np.sqrt(Q * dt) + dt * own)
    moved = np.asarray(ROVER.ahead(jnp.zeros(3), now, jnp.asarray(dt)))
    v, w = np.nan_to_num([forward, turn])
    np.testing.assert_allclose(moved, [v * dt * np.cos(w), v * dt * np.sin(w), w * dt], atol=1e-12)


def test_ranges_are_to_the_landmarks_wherever_it_looks() -> None:
    at = np.array([1.0, 2.0])
    want = [np.hypot(*(at - mark)) for mark in LANDMARKS]
    for heading in (0.0, 2.0):
        np.testing.assert_allclose(ROVER.expected(jnp.asarray([*at, heading]), sample()), want)
    assert ROVER.ready(sample()).all()


def test_it_begins_at_a_whole_pose() -> None:
    state, spread, result = ROVER.start(sample(pose=(1.0, 2.0, 0.5)))
    np.testing.assert_allclose(state, [1.0, 2.0, 0.5])
    np.testing.assert_allclose(spread, [0.1, 0.2, 0.3])
    assert result
    assert not ROVER.start(sample(pose=(1.0, 2.0, np.nan)))[2]


def test_lost_is_a_matter_of_place() -> None:
    assert ROVER.lost(jnp.zeros(3), jnp.asarray([101.0, 0.1, 0.1]))
    assert not ROVER.lost(jnp.zeros(3), jnp.asarray([99.0, 99.0, 1e3]))
