"""Normal gravity of the WGS-84 ellipsoid (as a plumb line shows it), as a vector in the earth's frame.

Source: W. A. Heiskanen, H. Moritz, Physical Geodesy (1967), section 2-9; the zonal terms as vectors are those of
O. Montenbruck, E. Gill, Satellite Orbits (2000), section 3.2.
"""

from typing import Any

from jaxtyping import Float

from sensorfault.numerics.geodesy import SEMI_MAJOR_AXIS
from sensorfault.numerics.gnss.constants import EARTH_RATE_RAD_S
from sensorfault.numerics.gnss.namespace import namespace

_MU = 3.986_004_418e14  # of the earth with its air [m³/s²] (NGA.STND.0036, table 3.1)
# Zonal harmonics of the ellipsoid itself (Heiskanen and Moritz 2-92); the next one would add 1e-7 m/s².
_J2, _J4 = 1.082_629_82e-3, -2.370_911e-6


def gravity(position: Float[Any, "*n 3"]) -> Float[Any, "*n 3"]:
    """Gravitation and centrifugal acceleration together [m/s²]; to 1e-6 m/s² of the normal field up to 20 km.

    Args:
        position: ECEF [m], NumPy's or JAX's.

    The real field leaves the normal one by up to 1e-3 m/s² (anomalies) and 3e-4 rad (deflection of the vertical).
    """
    xp = namespace(position)
    squared = (position**2).sum(axis=-1, keepdims=True)
    flat = SEMI_MAJOR_AXIS**2 / squared  # (a / r)²
    s = position[..., 2:] ** 2 / squared  # sin² of the geocentric latitude
    second, fourth = 1.5 * _J2 * flat, 0.625 * _J4 * flat**2
    # g = -μ r / r³ (1 + 3/2 J2 (a/r)² (1 - 5 s) - 15/8 J4 (a/r)⁴ (1 - 14 s + 21 s²)) + Ω² (x, y, 0)
    across = 1 + second * (1 - 5 * s) - fourth * (3 - 42 * s + 63 * s**2)
    # and along the axis: 1 + 3/2 J2 (a/r)² (3 - 5 s) - 5/8 J4 (a/r)⁴ (15 - 70 s + 63 s²)
    along = 1 + second * (3 - 5 * s) - fourth * (15 - 70 * s + 63 * s**2)
    pull = -_MU / squared**1.5
    turning = EARTH_RATE_RAD_S**2
    return position * xp.concat((pull * across + turning, pull * across + turning, pull * along), axis=-1)
