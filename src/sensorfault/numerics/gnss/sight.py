"""The path of a signal: distance with the earth's rotation, direction, and noise of the pseudorange."""

from typing import Any

from jaxtyping import Float

from sensorfault.numerics.gnss.constants import EARTH_RATE_RAD_S, LIGHT_M_S
from sensorfault.numerics.gnss.namespace import namespace
from sensorfault.numerics.gnss.turn import turn

Numbers = float | Float[Any, "*#n"]
Points = Float[Any, "*#n 3"]


def turned(satellite: Points, flight_s: Numbers) -> Float[Any, "*#n 3"]:
    """A satellite's position in the earth's frame at the time of arrival: rotated by Ω̇e τ.

    Args:
        satellite: ECEF of the time of transmission [m].
        flight_s: τ, how long the signal was under way [s].

    Source: Groves (2013), equation 8.36 before it is made linear.
    """
    xp = namespace(satellite, flight_s)
    angle = EARTH_RATE_RAD_S * flight_s
    x, y = turn(satellite[..., 0], satellite[..., 1], angle)
    return xp.stack((x, y, satellite[..., 2] + 0 * angle), axis=-1)


def distance(receiver: Points, satellite: Points) -> Float[Any, "*#n"]:
    """Distance that the signal travelled [m], with the earth's rotation meanwhile (Sagnac).

    Args:
        receiver: ECEF of the time of arrival [m].
        satellite: ECEF of the time of transmission [m].

    Source: Groves (2013), equations 8.35 and 8.36; to a micrometre for satellites up to geostationary orbit.
    """
    xp = namespace(receiver, satellite)
    away = satellite - receiver
    straight = xp.sqrt((away**2).sum(axis=-1))
    # ρ = |rs - r| + Ω̇e / c (ys xr - xs yr), and once more with the frame turned by the time that takes
    across = satellite[..., 1] * receiver[..., 0] - satellite[..., 0] * receiver[..., 1]
    sagnac = EARTH_RATE_RAD_S / LIGHT_M_S * across
    away = turned(satellite, (straight - sagnac) / LIGHT_M_S) - receiver
    return xp.sqrt((away**2).sum(axis=-1))


def elevation_azimuth(
    receiver: Points, satellite: Points, axes: Float[Any, "*#n 3 3"]
) -> tuple[Float[Any, "*#n"], Float[Any, "*#n"]]:
    """Elevation above the horizon, and azimuth from north over east [rad].

    Args:
        receiver: ECEF [m].
        satellite: ECEF [m].
        axes: rows east, north and up in ECEF at the receiver, as of `geodesy.enu_axes`.

    Source: Groves (2013), equation 8.57.
    """
    xp = namespace(receiver, satellite, axes)
    local = (axes * (satellite - receiver)[..., None, :]).sum(axis=-1)
    east, north, up = local[..., 0], local[..., 1], local[..., 2]
    return xp.atan2(up, xp.hypot(east, north)), xp.atan2(east, north) % (2 * xp.pi)


def pseudorange_sigma(elevation: Numbers, zenith: float = 0.3, horizon: float = 0.3, least: float = 0.0873) -> Numbers:
    """Standard deviation of a pseudorange [m]: σ² = zenith² + horizon² / sin² el.

    Args:
        elevation: [rad]; below `least` (5 degrees) as there.
        zenith: the part that is the same everywhere [m].
        horizon: the part that grows with the way through the air [m].
        least: [rad].

    Source: RTKLIB 2.4.2, rtkpos.c, varerr, with the factor of its code measurements put into the two parts.
    """
    xp = namespace(elevation)
    # σ² = a² + b² / sin² el
    return xp.sqrt(zenith**2 + horizon**2 / xp.sin(xp.maximum(elevation, least)) ** 2)
