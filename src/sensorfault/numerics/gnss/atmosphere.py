"""Atmospheric delays of a pseudorange [m], by the models of single-frequency receivers. Angles in rad."""

from typing import Any

from jaxtyping import Float

from sensorfault.numerics.gnss.constants import L1_HZ, LIGHT_M_S
from sensorfault.numerics.gnss.namespace import namespace

_NIGHT_S = 5e-9  # the delay by night
_NOON_S = 50_400.0  # local time of the largest delay: 14 o'clock
_LEAST_PERIOD_S = 72_000.0
_DAY_S = 86_400.0
_LOWEST = 0.0524  # elevation below which the mapping to the zenith is not valid: 3 degrees [rad]

Numbers = float | Float[Any, "*#n"]


def klobuchar(
    coefficients: Float[Any, "8"],
    latitude: Float[Any, ""] | float,
    longitude: Float[Any, ""] | float,
    elevation: Numbers,
    azimuth: Numbers,
    time_of_week: Numbers | float,
    frequency: Numbers | float = L1_HZ,
) -> Numbers:
    """Delay by the ionosphere [m] (IS-GPS-200, figure 20-4); it corrects about half of the true delay.

    Args:
        coefficients: the broadcast α0 to α3 and β0 to β3.
        latitude: of the receiver.
        longitude: of the receiver.
        elevation: of the satellites.
        azimuth: of the satellites.
        time_of_week: of GPS [s].
        frequency: of the signal [Hz]; the delay falls with its square.
    """
    xp = namespace(coefficients, elevation, azimuth)
    half = xp.pi  # the document counts angles in semicircles
    el, lat, lon = elevation / half, latitude / half, longitude / half
    # ψ = 0.0137 / (E + 0.11) - 0.022
    psi = 0.0137 / (el + 0.11) - 0.022
    # φi = φu + ψ cos A, within ±0.416;  λi = λu + ψ sin A / cos φi;  φm = φi + 0.064 cos(λi - 1.617)
    phi = xp.clip(lat + psi * xp.cos(azimuth), -0.416, 0.416)
    lam = lon + psi * xp.sin(azimuth) / xp.cos(phi * half)
    phi_m = phi + 0.064 * xp.cos((lam - 1.617) * half)
    # t = 4.32e4 λi + GPS time, within a day
    local = (43_200.0 * lam + time_of_week) % _DAY_S
    # F = 1 + 16 (0.53 - E)³
    slant = 1 + 16 * (0.53 - el) ** 3
    powers = xp.stack((phi_m**0, phi_m, phi_m**2, phi_m**3), axis=-1)
    amplitude = xp.maximum((powers * coefficients[:4]).sum(axis=-1), 0.0)
    period = xp.maximum((powers * coefficients[4:]).sum(axis=-1), _LEAST_PERIOD_S)
    # x = 2π (t - 50400) / PER;  T = F (5e-9 + AMP (1 - x²/2 + x⁴/24)) for |x| < 1.57, else F 5e-9
    x = 2 * xp.pi * (local - _NOON_S) / period
    wave = xp.where(xp.abs(x) < 1.57, amplitude * (1 - x**2 / 2 + x**4 / 24), 0.0)
    return LIGHT_M_S * slant * (_NIGHT_S + wave) * (L1_HZ / frequency) ** 2


def saastamoinen(
    latitude: Float[Any, ""] | float,
    height: Float[Any, ""] | float,
    elevation: Numbers,
    humidity: float = 0.7,
) -> Numbers:
    """Delay by the troposphere in a standard atmosphere [m] (RTKLIB 2.4.2 manual, equations E.5.1 to E.5.4).

    Args:
        latitude: of the receiver.
        height: of the receiver [m], held within 0 and 10 km; above the sea, though above the ellipsoid is near enough.
        elevation: of the satellites; below 3 degrees as there.
        humidity: relative, 0 to 1.
    """
    xp = namespace(latitude, height, elevation)
    h = xp.clip(height, 0.0, 1e4)
    # p = 1013.25 (1 - 2.2557e-5 h)^5.2568 [hPa],  T = 15 - 6.5e-3 h + 273.15 [K]
    pressure = 1013.25 * (1 - 2.2557e-5 * h) ** 5.2568
    temperature = 15.0 - 6.5e-3 * h + 273.15
    # e = 6.108 exp((17.15 T - 4684) / (T - 38.45)) h_rel [hPa]
    vapour = 6.108 * humidity * xp.exp((17.15 * temperature - 4684.0) / (temperature - 38.45))
    zenith_angle = xp.pi / 2 - xp.maximum(elevation, _LOWEST)
    # hydrostatic: 0.0022768 p / (1 - 0.00266 cos 2φ - 0.00028 h / 1 km) / cos z
    dry = 0.0022768 * pressure / (1 - 0.00266 * xp.cos(2.0 * latitude) - 0.00028e-3 * h)
    # wet: 0.002277 (1255 / T + 0.05) e / cos z
    wet = 0.002277 * (1255.0 / temperature + 0.05) * vapour
    return (dry + wet) / xp.cos(zenith_angle)
