"""East and north of a point in metres, inside a compiled step: short distances on the WGS-84 ellipsoid.

The middle-latitude formula, good to a millimetre over 10 km below 60 degrees. Across the date line the short way is
taken; within FARTHEST of a pole east means nothing and there is no answer.
"""

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.numerics.geodesy import ECCENTRICITY_SQUARED, FARTHEST, SEMI_MAJOR_AXIS

Number = Float[Array, ""]


def wrapped(angle: Float[Array, "*n"]) -> Float[Array, "*n"]:
    """The same angle within (-pi, pi]."""
    near: Float[Array, "*n"] = angle - 2 * jnp.pi * jnp.ceil(angle / (2 * jnp.pi) - 0.5)
    return near


def on_the_map(latitude: Number, longitude: Number) -> Bool[Array, ""]:
    """Whether these are coordinates [rad] that a vehicle can have: finite, on the globe and not at a pole."""
    there: Bool[Array, ""] = (jnp.abs(latitude) <= FARTHEST) & (jnp.abs(longitude) <= 2 * jnp.pi)
    return there


def east_north(latitude: Number, longitude: Number, from_latitude: Number, from_longitude: Number) -> Float[Array, "2"]:
    """Displacement from one point to another, east and north [m]; angles in rad. Zeros if one is not `on_the_map`."""
    good = on_the_map(latitude, longitude) & on_the_map(from_latitude, from_longitude)
    middle = jnp.where(good, (latitude + from_latitude) / 2, 0.0)
    # N = a / √(1 - e² sin²φ),  M = N³ (1 - e²) / a²
    n = SEMI_MAJOR_AXIS / jnp.sqrt(1 - ECCENTRICITY_SQUARED * jnp.sin(middle) ** 2)
    m = n**3 * (1 - ECCENTRICITY_SQUARED) / SEMI_MAJOR_AXIS**2
    # e = N cos φm Δλ,  n = M Δφ
    east = n * jnp.cos(middle) * wrapped(longitude - from_longitude)
    north = m * (latitude - from_latitude)
    return jnp.where(good, jnp.stack([east, north]), 0.0)


def moved(latitude: Number, longitude: Number, way: Float[Array, "2"]) -> Float[Array, "2"]:
    """The point [latitude, longitude in rad] that lies `way` (east, north) [m] from another."""
    to = latitude
    for _ in range(3):  # the middle latitude needs the end of the way
        middle = (latitude + to) / 2
        n = SEMI_MAJOR_AXIS / jnp.sqrt(1 - ECCENTRICITY_SQUARED * jnp.sin(middle) ** 2)
        to = latitude + way[1] * SEMI_MAJOR_AXIS**2 / (n**3 * (1 - ECCENTRICITY_SQUARED))
    return jnp.stack([to, wrapped(longitude + way[0] / (n * jnp.maximum(jnp.cos(middle), 1e-3)))])
