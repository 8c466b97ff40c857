"""The WGS-84 ellipsoid: geodetic, earth-centred (ECEF) and local east-north-up coordinates.

Angles in rad, lengths in m; every function takes scalars or arrays and broadcasts. Points are arrays (..., 3).

Source: P. D. Groves, Principles of GNSS, Inertial, and Multisensor Integrated Navigation Systems, 2nd ed. (2013),
section 2.4; the constants are those of NGA.STND.0036 (2014), table 3.1.
"""

import numpy as np
from jaxtyping import Float

SEMI_MAJOR_AXIS = 6_378_137.0  # a [m]
FARTHEST = np.deg2rad(89.9)  # east is defined up to this latitude [rad]
FLATTENING = 1 / 298.257223563  # f
ECCENTRICITY_SQUARED = FLATTENING * (2 - FLATTENING)  # e²
SEMI_MINOR_AXIS = SEMI_MAJOR_AXIS * (1 - FLATTENING)  # b [m]

Numbers = float | Float[np.ndarray, "..."]
Points = Float[np.ndarray, "*n 3"]


def transverse_radius(latitude: Numbers) -> Float[np.ndarray, "*n"]:
    """Radius of curvature of the prime vertical, east-west [m] (Groves 2.106)."""
    # N = a / √(1 - e² sin²φ)
    return np.asarray(SEMI_MAJOR_AXIS / np.sqrt(1 - ECCENTRICITY_SQUARED * np.sin(latitude) ** 2))


def meridian_radius(latitude: Numbers) -> Float[np.ndarray, "*n"]:
    """Radius of curvature of the meridian, north-south [m] (Groves 2.105)."""
    # M = a (1 - e²) / (1 - e² sin²φ)^(3/2)
    return np.asarray(transverse_radius(latitude) ** 3 * (1 - ECCENTRICITY_SQUARED) / SEMI_MAJOR_AXIS**2)


def geodetic_to_ecef(latitude: Numbers, longitude: Numbers, height: Numbers) -> Points:
    """Latitude, longitude [rad] and height above the ellipsoid [m] -> ECEF (..., 3) [m] (Groves 2.112)."""
    lat, lon, h = np.broadcast_arrays(latitude, longitude, height)
    n = transverse_radius(lat)
    # x = (N + h) cos φ cos λ,  y = (N + h) cos φ sin λ,  z = ((1 - e²) N + h) sin φ
    across = (n + h) * np.cos(lat)
    return np.stack(
        (across * np.cos(lon), across * np.sin(lon), ((1 - ECCENTRICITY_SQUARED) * n + h) * np.sin(lat)), axis=-1
    )


def ecef_to_geodetic(
    point: Points,
) -> tuple[Float[np.ndarray, "*n"], Float[np.ndarray, "*n"], Float[np.ndarray, "*n"]]:
    """ECEF (..., 3) [m] -> latitude, longitude [rad], height [m]; not for the earth's centre.

    Bowring's iteration on the reduced latitude β (Survey Review 23, 1976), three rounds: to 1e-12 rad from 10 km below
    the surface to geostationary orbit.
    """
    x, y, z = np.moveaxis(np.asarray(point, dtype=float), -1, 0)
    p = np.hypot(x, y)
    second = ECCENTRICITY_SQUARED / (1 - ECCENTRICITY_SQUARED)  # e'²
    beta = np.arctan2(z * SEMI_MAJOR_AXIS, p * SEMI_MINOR_AXIS)
    for _ in range(3):
        # tan φ = (z + e'² b sin³β) / (p - e² a cos³β),  tan β = (1 - f) tan φ
        lat = np.arctan2(
            z + second * SEMI_MINOR_AXIS * np.sin(beta) ** 3,
            p - ECCENTRICITY_SQUARED * SEMI_MAJOR_AXIS * np.cos(beta) ** 3,
        )
        beta = np.arctan2((1 - FLATTENING) * np.sin(lat), np.cos(lat))
    # h = p cos φ + z sin φ - a √(1 - e² sin²φ), which holds at the poles too
    height = p * np.cos(lat) + z * np.sin(lat) - SEMI_MAJOR_AXIS**2 / transverse_radius(lat)
    return np.asarray(lat), np.asarray(np.arctan2(y, x)), np.asarray(height)


def enu_axes(latitude: Numbers, longitude: Numbers) -> Float[np.ndarray, "*n 3 3"]:
    """Rotation ECEF -> local frame: the rows are the east, north and up unit vectors (Groves 2.150, rows reordered)."""
    lat, lon = np.broadcast_arrays(latitude, longitude)
    sin_lat, cos_lat, sin_lon, cos_lon = np.sin(lat), np.cos(lat), np.sin(lon), np.cos(lon)
    east = np.stack((-sin_lon, cos_lon, np.zeros_like(sin_lon)), axis=-1)
    north = np.stack((-sin_lat * cos_lon, -sin_lat * sin_lon, cos_lat), axis=-1)
    up = np.stack((cos_lat * cos_lon, cos_lat * sin_lon, sin_lat), axis=-1)
    return np.stack((east, north, up), axis=-2)


def ecef_to_enu(point: Points, latitude: float, longitude: float, height: float) -> Points:
    """ECEF (..., 3) [m] -> east, north, up [m] from an origin given in rad, rad, m."""
    away = np.asarray(point) - geodetic_to_ecef(latitude, longitude, height)
    return np.asarray(away @ enu_axes(latitude, longitude).T)


def enu_to_ecef(point: Points, latitude: float, longitude: float, height: float) -> Points:
    """East, north, up (..., 3) [m] from an origin given in rad, rad, m -> ECEF [m]."""
    return np.asarray(np.asarray(point) @ enu_axes(latitude, longitude) + geodetic_to_ecef(latitude, longitude, height))
