"""Broadcast Keplerian orbits: GPS, QZSS, Galileo and BeiDou.

Source: IS-GPS-200 (2022), tables 20-IV and 20.3.3.3.3.1; Galileo OS SIS ICD (2021), tables 64 and 5.1.3;
BDS-SIS-ICD-B1I 3.0 (2019), table 5-11. Times are seconds of GPS time since 1980-01-06, which a float64 holds to 0.2 µs
(a millimetre of a satellite's way).
"""

from typing import Any, NamedTuple

from jaxtyping import Float

from sensorfault.numerics.gnss.constants import LIGHT_M_S
from sensorfault.numerics.gnss.namespace import namespace
from sensorfault.numerics.gnss.turn import turn

_ROUNDS = 6  # of Newton's method; an eccentricity of 0.3 needs five to reach 1e-15
_STEP_S = 0.5

Each = Float[Any, "*#n"]
Numbers = float | Each


class Ephemeris(NamedTuple):
    """One satellite's broadcast parameters each, all of one shape; angles in rad, the documents' names in comments."""

    toe: Each  # reference time of the orbit [s]
    toc: Each  # reference time of the clock [s]
    af0: Each  # clock: offset [s]
    af1: Each  # drift [s/s]
    af2: Each  # ageing [s/s²]
    group_delay: Each  # TGD or BGD of the received frequency [s]
    sqrt_a: Each  # √A [√m]
    eccentricity: Each  # e
    anomaly: Each  # M0
    delta_n: Each  # Δn [rad/s]
    node: Each  # Ω0
    node_rate: Each  # Ω̇ [rad/s]
    inclination: Each  # i0
    inclination_rate: Each  # IDOT [rad/s]
    perigee: Each  # ω
    cuc: Each
    cus: Each
    crc: Each  # [m]
    crs: Each  # [m]
    cic: Each
    cis: Each
    toe_of_week: Each  # toe counted from the start of its own system's week [s]
    mu: Each  # [m³/s²]
    earth_rate: Each  # Ω̇e [rad/s]
    tilt: Each  # of the orbit's reference equator about the x axis; 0 except for geostationary satellites


def eccentric_anomaly(mean: Numbers, eccentricity: Numbers) -> Numbers:
    """E of Kepler's equation M = E - e sin E [rad]; eccentricities up to 0.3."""
    xp = namespace(mean, eccentricity)
    found = mean + eccentricity * xp.sin(mean)
    for _ in range(_ROUNDS):
        # E ← E - (E - e sin E - M) / (1 - e cos E)
        found = found - (found - eccentricity * xp.sin(found) - mean) / (1 - eccentricity * xp.cos(found))
    return found


def position(ephemeris: Ephemeris, time: Numbers) -> Float[Any, "*#n 3"]:
    """Positions of the satellites in the earth's frame (ECEF) at that time [m].

    Args:
        ephemeris: of any shape that broadcasts with `time`.
        time: of transmission [s of GPS time].
    """
    xp = namespace(time, *ephemeris)
    since = time - ephemeris.toe
    anomaly = _anomaly(ephemeris, since)
    e = ephemeris.eccentricity
    # ν = atan2(√(1 - e²) sin E, cos E - e),  φ = ν + ω
    true = xp.atan2(xp.sqrt(1 - e**2) * xp.sin(anomaly), xp.cos(anomaly) - e)
    phi = true + ephemeris.perigee
    sin2, cos2 = xp.sin(2 * phi), xp.cos(2 * phi)
    # u = φ + Cus sin 2φ + Cuc cos 2φ,  r = A (1 - e cos E) + Crs sin 2φ + Crc cos 2φ
    u = phi + ephemeris.cus * sin2 + ephemeris.cuc * cos2
    r = ephemeris.sqrt_a**2 * (1 - e * xp.cos(anomaly)) + ephemeris.crs * sin2 + ephemeris.crc * cos2
    # i = i0 + IDOT t + Cis sin 2φ + Cic cos 2φ
    i = ephemeris.inclination + ephemeris.inclination_rate * since + ephemeris.cis * sin2 + ephemeris.cic * cos2
    # Ω = Ω0 + Ω̇ t - Ω̇e toe: in a frame that stands still where the earth's was at toe
    node = ephemeris.node + ephemeris.node_rate * since - ephemeris.earth_rate * ephemeris.toe_of_week
    along, across = r * xp.cos(u), r * xp.sin(u)
    # x = x' cos Ω - y' cos i sin Ω,  y = x' sin Ω + y' cos i cos Ω,  z = y' sin i
    x = along * xp.cos(node) - across * xp.cos(i) * xp.sin(node)
    y = along * xp.sin(node) + across * xp.cos(i) * xp.cos(node)
    z = across * xp.sin(i)
    # Rz(Ω̇e t) Rx(tilt)
    y, z = turn(y, z, ephemeris.tilt)
    x, y = turn(x, y, ephemeris.earth_rate * since)
    return xp.stack((x, y, z), axis=-1)


def velocity(ephemeris: Ephemeris, time: Numbers) -> Float[Any, "*#n 3"]:
    """Velocities in the earth's frame [m/s], by a central difference over a second: to 1e-5 m/s."""
    return (position(ephemeris, time + _STEP_S) - position(ephemeris, time - _STEP_S)) / (2 * _STEP_S)


def clock(ephemeris: Ephemeris, time: Numbers) -> Each:
    """Clock offset of the satellites from GPS time [s], for single-frequency users.

    With the relativistic part and the group delay (IS-GPS-200, 20.3.3.3.3.1 and 20.3.3.3.3.2); `time` may be the
    satellite's own.
    """
    xp = namespace(time, *ephemeris)
    since = time - ephemeris.toc
    anomaly = _anomaly(ephemeris, time - ephemeris.toe)
    # Δtr = F e √A sin E,  F = -2 √μ / c²
    relativity = -2 * xp.sqrt(ephemeris.mu) / LIGHT_M_S**2 * ephemeris.eccentricity * ephemeris.sqrt_a * xp.sin(anomaly)
    # Δt = af0 + af1 t + af2 t² + Δtr - TGD
    return ephemeris.af0 + ephemeris.af1 * since + ephemeris.af2 * since**2 + relativity - ephemeris.group_delay


def _anomaly(ephemeris: Ephemeris, since: Numbers) -> Numbers:
    """Eccentric anomaly so many seconds after toe."""
    xp = namespace(since, *ephemeris)
    # n = √(μ / A³) + Δn,  M = M0 + n t
    n = xp.sqrt(ephemeris.mu) / ephemeris.sqrt_a**3 + ephemeris.delta_n
    return eccentric_anomaly(ephemeris.anomaly + n * since, ephemeris.eccentricity)
