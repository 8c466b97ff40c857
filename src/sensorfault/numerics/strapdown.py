"""Strapdown inertial navigation in the earth's frame (ECEF), for a compiled step: sums, no library calls.

Source: P. D. Groves, Principles of GNSS, Inertial, and Multisensor Integrated Navigation Systems, 2nd ed. (2013),
section 5.3.
"""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from typing import NamedTuple

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float

from sensorfault.numerics.gnss.constants import EARTH_RATE_RAD_S
from sensorfault.numerics.gravity import gravity


class Navigation(NamedTuple):
    """Position, velocity and attitude of a vehicle in ECEF; the attitude rotates body axes to ECEF."""

    attitude: Float[Array, "3 3"]
    velocity: Float[Array, "3"]  # [m/s]
    position: Float[Array, "3"]  # [m]


class Rows(NamedTuple):
    """R rows of an inertial unit: turn rates [rad/s] and specific force [m/s²] in body axes, and for how long each [s].

    `ok`: the row can be trusted; a row of length 0 does not count.
    """

    gyro: Float[Array, "R 3"]
    force: Float[Array, "R 3"]
    dt: Float[Array, " R"]
    ok: Bool[Array, " R"]


class Way(NamedTuple):
    """What the rows of a stretch came to: time [s], part of it without a row to believe, mean specific force in ECEF
    [m/s²] and mean attitude.
    """

    time: Float[Array, ""]
    blind: Float[Array, ""]
    force: Float[Array, "3"]
    attitude: Float[Array, "3 3"]


def cross(a: Float[Array, "3"], b: Float[Array, "3"]) -> Float[Array, "3"]:
    """a × b."""
    return jnp.stack([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


def skew(a: Float[Array, "3"]) -> Float[Array, "3 3"]:
    """[a ×]."""
    zero = jnp.zeros(())
    return jnp.stack([zero, -a[2], a[1], a[2], zero, -a[0], -a[1], a[0], zero]).reshape(3, 3)


def times(a: Float[Array, "m k"], b: Float[Array, "k n"]) -> Float[Array, "m n"]:
    """A B without a library call."""
    return (a[:, :, None] * b[None]).sum(axis=1)


def rotation(angle: Float[Array, "3"]) -> Float[Array, "3 3"]:
    """exp [α ×] by its series, to 1e-9 for turns up to 0.2 rad (Groves 5.73)."""
    s, t2 = skew(angle), (angle**2).sum()
    # I + (1 - θ²/6 + θ⁴/120) [α×] + (1/2 - θ²/24 + θ⁴/720) [α×]²
    return jnp.eye(3) + (1 - t2 / 6 + t2**2 / 120) * s + (0.5 - t2 / 24 + t2**2 / 720) * times(s, s)


def orthonormal(attitude: Float[Array, "3 3"]) -> Float[Array, "3 3"]:
    """Re-orthonormalise a matrix that is nearly a rotation: one step of C (3 I - Cᵀ C) / 2."""
    return 1.5 * attitude - 0.5 * times(attitude, times(attitude.T, attitude))


def advance(start: Navigation, rows: Rows, reckons: Bool[Array, ""]) -> tuple[Navigation, Way]:
    """Navigation after these rows. Where a row is not `ok`, or if not `reckons`, attitude and velocity stay.

    Gravity is taken where the rows begin: over a second of a fast train it turns by less than 1e-5 rad.
    """
    pull = gravity(start.position)
    earth = jnp.array([0.0, 0.0, EARTH_RATE_RAD_S])

    def one(now: tuple[Navigation, Way], row: Rows) -> tuple[tuple[Navigation, Way], None]:
        nav, way = now
        knows = row.ok & reckons
        # C⁺ = C exp[ω dt ×] - Ω C dt  (5.75)
        turned = times(nav.attitude, rotation(row.gyro * row.dt)) - times(skew(earth), nav.attitude) * row.dt
        attitude = jnp.where(knows, turned, nav.attitude)
        middle = (attitude + nav.attitude) / 2
        # f in ECEF = (C⁺ + C)/2 f  (5.84)
        force = (middle * row.force[None]).sum(axis=1)
        # v⁺ = v + (f + g - 2 ω × v) dt  (5.85)
        pulled = force + pull - 2 * cross(earth, nav.velocity)
        velocity = nav.velocity + jnp.where(knows, pulled, 0.0) * row.dt
        # r⁺ = r + (v + v⁺)/2 dt  (5.38)
        position = nav.position + (nav.velocity + velocity) / 2 * row.dt
        sums = Way(
            way.time + row.dt,
            way.blind + jnp.where(knows, 0.0, row.dt),
            way.force + jnp.where(knows, force, 0.0) * row.dt,
            way.attitude + middle * row.dt,
        )
        return (Navigation(attitude, velocity, position), sums), None

    none = Way(jnp.zeros(()), jnp.zeros(()), jnp.zeros(3), jnp.zeros((3, 3)))
    (end, way), _ = lax.scan(one, (start, none), rows)
    long = jnp.maximum(way.time, 1e-9)
    mean = jnp.where(way.time > 0, way.attitude / long, start.attitude)
    return end, way._replace(force=way.force / long, attitude=mean)
