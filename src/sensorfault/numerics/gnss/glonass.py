"""GLONASS broadcasts a state, not an orbit: it is integrated from its reference time.

Source: GLONASS ICD, edition 5.1 (2008), appendix 3.1.2 and 3.3.3 (frame PZ-90, within decimetres of WGS-84). Times are
seconds of GPS time since 1980-01-06.
"""

from typing import Any, NamedTuple

from jaxtyping import Float

from sensorfault.numerics.gnss.namespace import namespace

_MU = 3.986_004_418e14  # [m³/s²]
_EQUATOR_M = 6_378_136.0  # ae
_J2 = 1.082_625_75e-3  # second zonal harmonic; the ICD has C20 = -J2
_RATE = 7.292_115e-5  # ω of PZ-90 [rad/s]
STEPS = 15  # Runge-Kutta steps; a minute each at the end of the 15 minutes for which a state is valid

Each = Float[Any, "*#n"]
Numbers = float | Each
Vectors = Float[Any, "*#n 3"]


class GlonassEphemeris(NamedTuple):
    """One satellite's broadcast state each, all of one shape."""

    toe: Each  # tb, reference time [s]
    offset: Each  # -τn: the clock is so far ahead [s]
    drift: Each  # γn, relative frequency
    start: Vectors  # position [m]
    speed: Vectors  # velocity [m/s]
    pull: Vectors  # acceleration by sun and moon [m/s²]


def state(ephemeris: GlonassEphemeris, time: Numbers) -> tuple[Vectors, Vectors]:
    """Position [m] and velocity [m/s] in the earth's frame at that time (ICD, appendix 3.1.2)."""
    xp = namespace(time, *ephemeris)
    step = ((time - ephemeris.toe) / STEPS)[..., None]
    place, speed = ephemeris.start, ephemeris.speed
    for _ in range(STEPS):
        # y ← y + h (k1 + 2 k2 + 2 k3 + k4) / 6
        v1, a1 = speed, _acceleration(xp, place, speed, ephemeris.pull)
        v2 = speed + step / 2 * a1
        a2 = _acceleration(xp, place + step / 2 * v1, v2, ephemeris.pull)
        v3 = speed + step / 2 * a2
        a3 = _acceleration(xp, place + step / 2 * v2, v3, ephemeris.pull)
        v4 = speed + step * a3
        a4 = _acceleration(xp, place + step * v3, v4, ephemeris.pull)
        place = place + step / 6 * (v1 + 2 * v2 + 2 * v3 + v4)
        speed = speed + step / 6 * (a1 + 2 * a2 + 2 * a3 + a4)
    return place, speed


def clock(ephemeris: GlonassEphemeris, time: Numbers) -> Each:
    """Clock offset of the satellites from GPS time [s]; relativity is in γ (ICD, 3.3.3)."""
    # Δt = -τn + γn (t - tb)
    return ephemeris.offset + ephemeris.drift * (time - ephemeris.toe)


def _acceleration(xp: Any, place: Vectors, speed: Vectors, pull: Vectors) -> Vectors:
    """Acceleration in the rotating frame: gravitation with J2, rotation of the frame, sun and moon."""
    x, y, z = place[..., 0], place[..., 1], place[..., 2]
    r2 = x**2 + y**2 + z**2
    # a = μ / r³,  b = 3/2 J2 μ ae² / r⁵,  c = 5 z² / r²
    a = _MU / r2**1.5
    b = 1.5 * _J2 * _MU * _EQUATOR_M**2 / r2**2.5
    c = 5 * z**2 / r2
    # ẍ = (-a - b (1 - c) + ω²) x + 2 ω ẏ,  ÿ = ( ... ) y - 2 ω ẋ,  z̈ = (-a - b (3 - c)) z
    around = -a - b * (1 - c) + _RATE**2
    return pull + xp.stack(
        (around * x + 2 * _RATE * speed[..., 1], around * y - 2 * _RATE * speed[..., 0], (-a - b * (3 - c)) * z),
        axis=-1,
    )
