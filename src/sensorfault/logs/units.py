"""Units of files and SI. A unit is a factor to SI; unknown units are kept unchanged."""

from typing import TypeVar

import numpy as np

STANDARD_GRAVITY = 9.80665  # [m/s^2]
DEGREE = np.pi / 180
KNOT = 1852 / 3600  # [m/s]
FOOT = 0.3048  # [m]

# unit -> (SI unit, factor)
UNITS: dict[str, tuple[str, float]] = {
    "": ("", 1.0),
    "1": ("", 1.0),
    "%": ("", 0.01),
    "rad": ("rad", 1.0),
    "deg": ("rad", DEGREE),
    "cdeg": ("rad", 1e-2 * DEGREE),
    "1e-7deg": ("rad", 1e-7 * DEGREE),
    "rad/s": ("rad/s", 1.0),
    "deg/s": ("rad/s", DEGREE),
    "mrad/s": ("rad/s", 1e-3),
    "cdeg/s": ("rad/s", 1e-2 * DEGREE),
    "m/s^2": ("m/s^2", 1.0),
    "g": ("m/s^2", STANDARD_GRAVITY),
    "mg": ("m/s^2", 1e-3 * STANDARD_GRAVITY),
    "m": ("m", 1.0),
    "mm": ("m", 1e-3),
    "cm": ("m", 1e-2),
    "km": ("m", 1e3),
    "ft": ("m", FOOT),
    "m/s": ("m/s", 1.0),
    "cm/s": ("m/s", 1e-2),
    "mm/s": ("m/s", 1e-3),
    "km/h": ("m/s", 1 / 3.6),
    "kn": ("m/s", KNOT),
    "Pa": ("Pa", 1.0),
    "hPa": ("Pa", 1e2),
    "mbar": ("Pa", 1e2),
    "kPa": ("Pa", 1e3),
    "bar": ("Pa", 1e5),
    "T": ("T", 1.0),
    "uT": ("T", 1e-6),
    "gauss": ("T", 1e-4),
    "mgauss": ("T", 1e-7),
    "V": ("V", 1.0),
    "cV": ("V", 1e-2),
    "mV": ("V", 1e-3),
    "A": ("A", 1.0),
    "cA": ("A", 1e-2),
    "mA": ("A", 1e-3),
    "N": ("N", 1.0),
    "Nm": ("Nm", 1.0),
    "Hz": ("Hz", 1.0),
    "rpm": ("rad/s", 2 * np.pi / 60),
    "degC": ("degC", 1.0),
    "cdegC": ("degC", 1e-2),
    "dB": ("dB", 1.0),
    "dBm": ("dBm", 1.0),
    "dB-Hz": ("dB-Hz", 1.0),
    "s": ("s", 1.0),
    "ms": ("s", 1e-3),
    "us": ("s", 1e-6),
    "ns": ("s", 1e-9),
}

_SPELLINGS = {
    "m/s2": "m/s^2",
    "m/s²": "m/s^2",
    "m/s/s": "m/s^2",
    "°": "deg",
    "°/s": "deg/s",
    "dps": "deg/s",
    "kph": "km/h",
    "kmh": "km/h",
    "kt": "kn",
    "knot": "kn",
    "knots": "kn",
    "celsius": "degC",
    "°C": "degC",
    "G": "gauss",
    "Gauss": "gauss",
    "mGauss": "mgauss",
    "deglatitude": "deg",
    "deglongitude": "deg",
    "degheading": "deg",
    "degE7": "1e-7deg",
    "mG": "mg",
}

Number = TypeVar("Number", float, np.ndarray)


def known(unit: str) -> bool:
    """Whether the unit has a factor to SI here."""
    return unit in UNITS or unit in _SPELLINGS


def spelled(unit: str) -> str:
    """The unit as it is spelled here: `m/s2` is `m/s^2`."""
    return _SPELLINGS.get(unit, unit)


def _factor(unit: str) -> tuple[str, float]:
    return UNITS.get(spelled(unit), (unit, 1.0))


def si_unit(unit: str) -> str:
    """The SI unit that values of this unit are kept in; an unknown unit stays itself."""
    return _factor(unit)[0]


def to_si(value: Number, unit: str) -> Number:
    """`value` in `unit` -> SI; itself where that is its unit."""
    factor = _factor(unit)[1]
    return value if factor == 1.0 else value * factor


def from_si(value: Number, unit: str) -> Number:
    """SI -> `unit`."""
    return value / _factor(unit)[1]
