"""Growth of the errors of GNSS/INS navigation, and their correction by an estimate.

17 errors, estimate minus truth: attitude ψ, velocity, position (3 each, in ECEF), what gyros and accelerometers show
too much (3 each, body axes), clock offset [m] and drift [m/s]; behind them one clock offset [m] for each further system
of satellites. Wang et al. 2023; Groves (2013), section 14.2.3.
"""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from typing import NamedTuple

import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.numerics.geodesy import ECCENTRICITY_SQUARED, SEMI_MAJOR_AXIS
from sensorfault.numerics.gnss.constants import EARTH_RATE_RAD_S
from sensorfault.numerics.gravity import gravity
from sensorfault.numerics.strapdown import Navigation, Way, orthonormal, rotation, skew, times

PSI, VEL, POS, GYRO, ACC = (slice(3 * i, 3 * i + 3) for i in range(5))
CLOCK, DRIFT, OFFSETS = 15, 16, 17


class Instruments(NamedTuple):
    """The estimated errors of the instruments; `corrected` adds to them."""

    gyro: Float[Array, "3"]  # bias [rad/s]
    force: Float[Array, "3"]  # bias [m/s²]
    clock: Float[Array, ""]  # offset [m]
    drift: Float[Array, ""]  # [m/s]
    offsets: Float[Array, " K"]  # clock offsets of further systems [m]


def transition(at: Navigation, way: Way, states: int) -> Float[Array, "n n"]:
    """Φ over a stretch, to first order (Groves 14.50)."""
    tau, knows = way.time, (way.time - way.blind) / jnp.maximum(way.time, 1e-9)
    earth = skew(jnp.array([0.0, 0.0, EARTH_RATE_RAD_S]))
    pull, away = gravity(at.position), jnp.sqrt((at.position**2).sum())
    z = at.position[2] / away
    # r_eS = R_E √(cos² L + (1 - e²)² sin² L)  (2.137), with the geocentric latitude
    surface = SEMI_MAJOR_AXIS * jnp.sqrt(1 - ECCENTRICITY_SQUARED * (2 - ECCENTRICITY_SQUARED) * z**2)
    eye, none = jnp.eye(3), jnp.zeros((3, 3))
    # Φvr = -2 τ γ r̂ᵀ / (r_eS |r̂|)
    tilt = -2 * tau * pull[:, None] * (at.position / away)[None] / surface
    turn = tau * knows * way.attitude
    blocks = [
        [eye - earth * tau * knows, none, none, turn, none],
        [-tau * skew(way.force), eye - 2 * earth * tau * knows, tilt * knows, none, turn],
        [none, eye * tau, eye, none, none],
        [none, none, none, eye, none],
        [none, none, none, none, eye],
    ]
    # the drift is that of the first clock alone
    ramp = jnp.eye(states - CLOCK, k=1) * jnp.eye(states - CLOCK, 1)
    clocks = jnp.eye(states - CLOCK) + tau * ramp
    left = jnp.zeros((15, states - CLOCK))
    inertial = jnp.concatenate([jnp.concatenate(row, axis=1) for row in blocks])
    return jnp.concatenate(
        [jnp.concatenate([inertial, left], axis=1), jnp.concatenate([left.T, clocks], axis=1)], axis=0
    )


def corrected(at: Navigation, own: Instruments, error: Float[Array, " n"]) -> tuple[Navigation, Instruments]:
    """Navigation and instruments corrected by the estimated errors (Groves 14.7 to 14.9)."""
    # C = (I - [ψ×]) Ĉ, which the exponential keeps a rotation
    attitude = orthonormal(times(rotation(-error[PSI]), at.attitude))
    nav = Navigation(attitude, at.velocity - error[VEL], at.position - error[POS])
    # the excess that the instruments show is bias that is not yet removed
    instruments = Instruments(
        own.gyro + error[GYRO],
        own.force + error[ACC],
        own.clock - error[CLOCK],
        own.drift - error[DRIFT],
        own.offsets - error[OFFSETS:],
    )
    return nav, instruments


def upward(position: Float[Array, "3"]) -> Float[Array, "3"]:
    """Normal of the ellipsoid near the ground, to 1e-5 rad below 10 km."""
    normal = position / jnp.array([1.0, 1.0, 1 - ECCENTRICITY_SQUARED])
    return normal / jnp.sqrt((normal**2).sum())
