"""Start of a navigation filter: position from one epoch, velocity from several, attitude from motion."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.numerics.ins_error import ACC, CLOCK, GYRO, POS, VEL, upward
from sensorfault.numerics.strapdown import Navigation, cross, times

UNSEEN, NOWHERE, MOVING, ALIGNED = range(4)  # phases: no satellite yet, no position, no attitude, complete
EARTH_M = 6.371e6
ANYWHERE_M = 1e7  # standard deviation of an unknown position [m]
COARSE = 1e6  # process noise in this phase, so that a very large covariance does not lose digits
FOUND_M = 100.0  # least squares has converged if a round moves the position by less [m]
SLOW = 3.0  # below this speed the course is no heading [m/s]
SURE = 0.25  # the course is used as heading once its standard deviation is below this [rad]
CANT = 0.07  # standard deviation of a vehicle's roll and pitch [rad]
SLIP = 0.05  # standard deviation of heading minus course [rad]


def spread(states: int, **of: float) -> Float[Array, " n"]:
    """Variances from standard deviations: psi, vel, pos, gyro, acc, clock, drift, and offsets of further systems."""
    names = ["psi", "vel", "pos", "gyro", "acc"]
    sigma = [of[name] for name in names for _ in range(3)] + [of["clock"], of["drift"]]
    return jnp.array(sigma + [of["offsets"]] * (states - len(sigma))) ** 2


def nowhere(states: int) -> Float[Array, "n n"]:
    """Covariance before a round of least squares over one epoch."""
    return jnp.diag(
        spread(states, psi=0.1, vel=1.0, pos=ANYWHERE_M, gyro=0.0, acc=0.0, clock=ANYWHERE_M, drift=1.0, offsets=1e4)
    )


def moving(states: int) -> Float[Array, "n n"]:
    """Initial covariance of a filter of position and velocity."""
    return jnp.diag(
        spread(states, psi=0.1, vel=50.0, pos=50.0, gyro=0.0, acc=0.0, clock=50.0, drift=500.0, offsets=1e3)
    )


def under(place: Float[Array, "S 3"], there: Bool[Array, " S"]) -> Float[Array, "3"]:
    """The point of the earth's surface below the mean of the satellites: start of the first round."""
    middle = jnp.where(there[:, None], place, 0.0).sum(axis=0)
    return EARTH_M * middle / jnp.maximum(jnp.sqrt((middle**2).sum()), 1.0)


def course_known(nav: Navigation, cov: Float[Array, "n n"]) -> Bool[Array, ""]:
    """Whether the velocity gives the heading of the vehicle."""
    ahead, _, fast = _course(nav)
    return (fast > SLOW) & (_doubt(ahead, nav, cov) < SURE * fast)


def along_course(
    nav: Navigation, cov: Float[Array, "n n"], gyro_bias: Float[Array, ""], force_bias: Float[Array, ""]
) -> tuple[Navigation, Float[Array, "n n"]]:
    """Attitude level and along the velocity, and the covariance of this assumption; the vehicle must not reverse."""
    ahead, up, fast = _course(nav)
    attitude = jnp.stack([ahead, cross(ahead, up), -up], axis=1)  # ahead, right, down
    head = _doubt(ahead, nav, cov) / jnp.maximum(fast, SLOW)
    about = CANT**2 * (jnp.eye(3) - up[:, None] * up[None]) + (head**2 + SLIP**2) * up[:, None] * up[None]
    states = len(cov)
    index = jnp.arange(states)
    of_unit = (index >= GYRO.start) & (index < ACC.stop)
    biases = jnp.where(of_unit, jnp.where(index < ACC.start, gyro_bias**2, force_bias**2), 0.0)
    own = jnp.pad(about, (0, states - 3)) + jnp.diag(biases)
    old = (index >= VEL.start) & (index < POS.stop) | (index >= CLOCK)
    return nav._replace(attitude=attitude), jnp.where(old[:, None] & old[None], cov, 0.0) + own


def _course(nav: Navigation) -> tuple[Float[Array, "3"], Float[Array, "3"], Float[Array, ""]]:
    """Unit vectors ahead and up, and the horizontal speed [m/s]."""
    up = upward(nav.position)
    level = nav.velocity - (nav.velocity * up).sum() * up
    fast = jnp.sqrt((level**2).sum())
    return level / jnp.maximum(fast, 1e-3), up, fast


def _doubt(ahead: Float[Array, "3"], nav: Navigation, cov: Float[Array, "n n"]) -> Float[Array, ""]:
    """Standard deviation of the horizontal velocity across its course [m/s]."""
    aside = cross(ahead, upward(nav.position))
    return jnp.sqrt(jnp.maximum((aside[:, None] * aside[None] * cov[VEL, VEL]).sum(), 0.0))


def forward(
    attitude: Float[Array, "3 3"], velocity: Float[Array, "3"]
) -> tuple[Float[Array, "3"], Float[Array, "3 6"]]:
    """Velocity ahead, to the right and down [m/s], and how it changes with the errors of attitude and velocity (3, 6).

    Cᵀ v; with errors Ĉᵀ v̂ - Cᵀ v = Cᵀ δv + Cᵀ [v ×] ψ.
    """
    back = attitude.T
    s = jnp.stack([cross(velocity, e) for e in jnp.eye(3)], axis=1)  # [v ×]
    return (back * velocity[None]).sum(axis=1), jnp.concatenate([times(back, s), back], axis=1)
