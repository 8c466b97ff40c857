"""Units of files and SI. A unit is a factor to SI; unknown units are kept unchanged."""

import re
from functools import cache
from typing import TypeVar

import numpy as np

STANDARD_GRAVITY = 9.80665  # [m/s^2]
DEGREE = np.pi / 180
KNOT = 1852 / 3600  # [m/s]
FOOT = 0.3048  # [m]
MILE = 1609.344  # [m]

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
    "mi": ("m", MILE),
    "m/s": ("m/s", 1.0),
    "cm/s": ("m/s", 1e-2),
    "mm/s": ("m/s", 1e-3),
    "km/h": ("m/s", 1 / 3.6),
    "kn": ("m/s", KNOT),
    "mph": ("m/s", MILE / 3600),
    "ft/s": ("m/s", FOOT),
    "ft/min": ("m/s", FOOT / 60),
    "m/min": ("m/s", 1 / 60),
    "cm/s^2": ("m/s^2", 1e-2),
    "ft/s^2": ("m/s^2", FOOT),
    "deg/h": ("rad/s", DEGREE / 3600),
    "Pa": ("Pa", 1.0),
    "hPa": ("Pa", 1e2),
    "mbar": ("Pa", 1e2),
    "kPa": ("Pa", 1e3),
    "bar": ("Pa", 1e5),
    "psi": ("Pa", 6894.757),
    "inHg": ("Pa", 3386.389),
    "mmHg": ("Pa", 133.322),
    "T": ("T", 1.0),
    "mT": ("T", 1e-3),
    "uT": ("T", 1e-6),
    "nT": ("T", 1e-9),
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
    "m/s/s": "m/s^2",
    "dps": "deg/s",
    "kph": "km/h",
    "kmh": "km/h",
    "kmph": "km/h",
    "kts": "kn",
    "kt": "kn",
    "fps": "ft/s",
    "fpm": "ft/min",
    "celsius": "degC",
    "°C": "degC",
    "G": "gauss",
    "Gs": "gauss",
    "Gauss": "gauss",
    "mGauss": "mgauss",
    "deglatitude": "deg",
    "deglongitude": "deg",
    "degheading": "deg",
    "degE7": "1e-7deg",
    "mG": "mg",
    "µT": "uT",
    "μT": "uT",
    "µs": "us",
    "μs": "us",
    "rpm": "rpm",
    "rev/min": "rpm",
    "1/min": "rpm",
    "percent": "%",
}
_WORDS = {  # of a unit, as they are written out
    "metre": "m", "meter": "m", "kilometre": "km", "kilometer": "km", "centimetre": "cm", "centimeter": "cm",
    "millimetre": "mm", "millimeter": "mm", "foot": "ft", "feet": "ft", "mile": "mi", "knot": "kn", "degree": "deg",
    "°": "deg", "radian": "rad", "second": "s", "sec": "s", "minute": "min", "hour": "h", "hr": "h", "volt": "V",
    "ampere": "A", "amp": "A", "pascal": "Pa", "hectopascal": "hPa", "kilopascal": "kPa", "millibar": "mbar",
    "tesla": "T", "microtesla": "uT", "nanotesla": "nT", "newton": "N", "hertz": "Hz", "gravity": "g", "gee": "g",
    "millisecond": "ms", "microsecond": "us", "nanosecond": "ns", "milligauss": "mgauss", "gravities": "g",
    "millivolt": "mV", "milliampere": "mA",
}  # fmt: skip
_SIGNS = str.maketrans("⁰¹²³⁴⁵⁶⁷⁸⁹⁻−·⋅", "0123456789--**")
_FACTOR = re.compile(r"([^\W\d_]+|°)(?:(?:\^|\*\*)?\(?(-?\d)\)?)?")

Number = TypeVar("Number", float, np.ndarray)


def known(unit: str) -> bool:
    """Whether the unit has a factor to SI here."""
    return spelled(unit) in UNITS


@cache
def spelled(unit: str) -> str:
    """The unit as it is spelled here: `m/s2`, `m s^-2` and `meters per second squared` are `m/s^2`."""
    if unit in UNITS or unit in _SPELLINGS:
        return _SPELLINGS.get(unit, unit)
    if unit.isupper() and len(unit) > 2:
        return spelled(unit.lower()) if spelled(unit.lower()) in UNITS else unit
    powers = _powers(unit)
    if powers is None:
        return unit
    above = [name if power == 1 else f"{name}^{power}" for name, power in powers.items() if power > 0]
    below = [name if power == -1 else f"{name}^{-power}" for name, power in powers.items() if power < 0]
    found = "/".join([" ".join(above) or "1", *below])
    found = _SPELLINGS.get(found, {"mi/h": "mph"}.get(found, found))
    return found if found in UNITS else unit


def _powers(unit: str) -> dict[str, int] | None:
    """The factors of a unit with their powers: {"m": 1, "s": -2}. None if it is none."""
    text = re.sub(r"(\w+) squared", r"\1^2", unit.strip().translate(_SIGNS), flags=re.IGNORECASE)
    text = re.sub(r"\s+per\s+|/", " / ", text, flags=re.IGNORECASE)
    powers: dict[str, int] = {}
    sign = 1
    for part in re.sub(r"(?<![\^*])\*(?!\*)|\.(?=[A-Za-z])", " ", text).split():
        match = _FACTOR.fullmatch(part)
        if part == "/":
            sign = -1
        elif match is not None:
            name = _word(match[1])
            powers[name] = powers.get(name, 0) + sign * int(match[2] or 1)
        elif part != "1":
            return None
    return powers or None


def _word(name: str) -> str:
    """The symbol of a unit that is written out; a symbol stays itself."""
    low = name.lower()
    if name in UNITS or (len(name) == 1 and name != "°"):
        return name
    return _WORDS.get(low) or _WORDS.get(low.removesuffix("s")) or (low if low in UNITS else name)


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
