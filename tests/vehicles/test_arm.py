"""Which column of a log says what of an arm, and its model in JAX."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np

from sensorfault.logs.table import Channel
from sensorfault.numerics.two_link import ahead
from sensorfault.simulation.arm import AS_PRINTED, motion
from sensorfault.vehicles.arm import Joints, joints
from sensorfault.vehicles.two_link import TwoLink


def test_the_columns_of_an_arm() -> None:
    log = motion(AS_PRINTED, 5)
    assert joints(log) == Joints((0, 1), (2, 3), (4, 5))
    other = replace(log, channels=(Channel("rate", "disk", "Hz"), *log.channels[1:5], Channel("torque", "x", "rad")))
    assert joints(other) == Joints((1,), (2, 3), (4,))


def test_the_model_and_its_slope() -> None:
    state, torque, dt = np.array([1.0, -2.0, 0.3, 0.4]), np.array([100.0, 20.0]), 0.01
    arm = TwoLink.of(AS_PRINTED.constants)

    def f(x):
        return ahead(AS_PRINTED.constants, x, torque, dt)

    inputs = jnp.asarray(state), jnp.asarray(torque), jnp.asarray(dt)
    np.testing.assert_allclose(arm.ahead(*inputs), f(state), rtol=1e-13)
    slope = np.stack([(f(state + 1e-5 * e) - f(state - 1e-5 * e)) / 2e-5 for e in np.eye(4)], axis=1)
    np.testing.assert_allclose(jax.jacfwd(arm.ahead)(*inputs), slope, atol=1e-8)
