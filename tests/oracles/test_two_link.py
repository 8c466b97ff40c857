"""The paper's equation (3) against Euler and Lagrange: from the energies of two bars as they lie in the plane."""

import numpy as np
import pytest

from sensorfault.numerics.two_link import Constants, accelerations, ahead, constants

MASS, LENGTH, CENTRE, INERTIA = (3.0, 2.0), 0.7, (0.4, 0.25), (0.12, 0.05)
STEP = 1e-4


def lagrangian(angle, rate, mass, length, centre, inertia) -> float:
    """Kinetic less potential energy; velocities by differencing the places of the centres of mass."""

    def places(q):
        elbow = length * np.array([np.cos(q[0]), np.sin(q[0])])
        first = centre[0] * np.array([np.cos(q[0]), np.sin(q[0])])
        return first, elbow + centre[1] * np.array([np.cos(q[0] + q[1]), np.sin(q[0] + q[1])])

    moved = zip(places(angle + STEP * rate), places(angle - STEP * rate), strict=True)
    velocity = [(after - before) / (2 * STEP) for after, before in moved]
    turning = rate[0], rate[0] + rate[1]
    kinetic = sum(m * v @ v / 2 + i * w**2 / 2 for m, v, i, w in zip(mass, velocity, inertia, turning, strict=True))
    return kinetic - 9.81 * sum(m * place[1] for m, place in zip(mass, places(angle), strict=True))


def euler_lagrange(angle, rate, torque, *links) -> np.ndarray:
    """d/dt dL/dq' - dL/dq = u, solved for q''."""
    own = np.eye(2)
    h = 1e-3

    def slope(i, q, w):
        """dL/dq'_i."""
        return (lagrangian(q, w + h * own[i], *links) - lagrangian(q, w - h * own[i], *links)) / (2 * h)

    inertia = [[(slope(i, angle, rate + h * e) - slope(i, angle, rate - h * e)) / (2 * h) for e in own] for i in (0, 1)]
    along = [(slope(i, angle + h * rate, rate) - slope(i, angle - h * rate, rate)) / (2 * h) for i in (0, 1)]
    force = [(lagrangian(angle + h * e, rate, *links) - lagrangian(angle - h * e, rate, *links)) / (2 * h) for e in own]
    return np.linalg.solve(np.array(inertia), np.asarray(torque) - along + force)


def test_equation_3_is_euler_and_lagrange() -> None:
    rng = np.random.default_rng(0)
    links = MASS, LENGTH, CENTRE, INERTIA
    for _ in range(20):
        rate, angle, torque = rng.uniform(-3, 3, 2), rng.uniform(-np.pi, np.pi, 2), rng.uniform(-20, 20, 2)
        ours = accelerations(constants(*links), np.concatenate([rate, angle]), torque)
        np.testing.assert_allclose(ours, euler_lagrange(angle, rate, torque, *links), rtol=1e-4, atol=1e-4)


def test_the_printed_constants_are_uniform_rods_but_for_a5() -> None:
    """Bars of a PUMA 560's masses and lengths: 15.91 and 11.36 kg, 0.432 m."""
    mass, length = (15.91, 11.36), 0.432
    rods = constants(mass, length, (length / 2, length / 2), (mass[0] * length**2 / 12, mass[1] * length**2 / 12))
    assert rods == pytest.approx((3.82, 2.12, 0.71, 81.82, 24.06), rel=5e-3)
    assert rods.a5 != pytest.approx(24.6, rel=0.02)


def test_a_step_is_eulers() -> None:
    a, state, torque = Constants(3.82, 2.12, 0.71, 81.82, 24.6), np.array([1.0, -2.0, 0.3, 0.4]), np.array([5.0, 6.0])
    after = ahead(a, state, torque, 0.01)
    np.testing.assert_allclose(after[2:], state[2:] + 0.01 * state[:2], rtol=1e-15)
    np.testing.assert_allclose(after[:2], state[:2] + 0.01 * accelerations(a, state, torque), rtol=1e-15)
