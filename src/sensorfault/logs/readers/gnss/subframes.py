"""Ephemerides from navigation messages: LNAV subframes of GPS and I/NAV words of Galileo.

Source: IS-GPS-200 (2022), figure 20-1 and tables 20-I, 20-III, 20-X; Galileo OS SIS ICD (2021), tables 37 to 47. How
u-blox packs them: F9 HPG interface description, RXM-SFRBX.
"""

import numpy as np
from jaxtyping import Float

from sensorfault.logs.readers.gnss.bits import Field, joined, nearest
from sensorfault.numerics.gnss.constants import EARTH_MU, EARTH_RATE
from sensorfault.numerics.gnss.kepler import Ephemeris

# Bits of a GPS subframe are counted without parity: 24 a word.
_LNAV_BITS = 240
_LNAV = {
    "group_delay": Field(1, 160, 8, -31),
    "toc": Field(1, 176, 16, 4, signed=False),
    "af2": Field(1, 192, 8, -55),
    "af1": Field(1, 200, 16, -43),
    "af0": Field(1, 216, 22, -31),
    "crs": Field(2, 56, 16, -5),
    "delta_n": Field(2, 72, 16, -43, angle=True),
    "anomaly": Field(2, 88, 32, -31, angle=True),
    "cuc": Field(2, 120, 16, -29),
    "eccentricity": Field(2, 136, 32, -33, signed=False),
    "cus": Field(2, 168, 16, -29),
    "sqrt_a": Field(2, 184, 32, -19, signed=False),
    "toe_of_week": Field(2, 216, 16, 4, signed=False),
    "cic": Field(3, 48, 16, -29),
    "node": Field(3, 64, 32, -31, angle=True),
    "cis": Field(3, 96, 16, -29),
    "inclination": Field(3, 112, 32, -31, angle=True),
    "crc": Field(3, 144, 16, -5),
    "perigee": Field(3, 160, 32, -31, angle=True),
    "node_rate": Field(3, 192, 24, -43, angle=True),
    "inclination_rate": Field(3, 224, 14, -43, angle=True),
}
_LNAV_ISSUES = (
    Field(1, 168, 8, 0, signed=False),
    Field(2, 48, 8, 0, signed=False),
    Field(3, 216, 8, 0, signed=False),
)
_LNAV_HEALTH = Field(1, 64, 6, 0, signed=False)
_KLOBUCHAR_PAGE = 56  # the satellite number that subframe 4's page 18 bears
_KLOBUCHAR = tuple(Field(4, 56 + 8 * i, 8, power) for i, power in enumerate((-30, -27, -24, -24, 11, 14, 16, 16)))

_INAV_BITS = 128
_INAV = {
    "toe_of_week": Field(1, 16, 14, 0, signed=False),  # minutes
    "anomaly": Field(1, 30, 32, -31, angle=True),
    "eccentricity": Field(1, 62, 32, -33, signed=False),
    "sqrt_a": Field(1, 94, 32, -19, signed=False),
    "node": Field(2, 16, 32, -31, angle=True),
    "inclination": Field(2, 48, 32, -31, angle=True),
    "perigee": Field(2, 80, 32, -31, angle=True),
    "inclination_rate": Field(2, 112, 14, -43, angle=True),
    "node_rate": Field(3, 16, 24, -43, angle=True),
    "delta_n": Field(3, 40, 16, -43, angle=True),
    "cuc": Field(3, 56, 16, -29),
    "cus": Field(3, 72, 16, -29),
    "crc": Field(3, 88, 16, -5),
    "crs": Field(3, 104, 16, -5),
    "cic": Field(4, 22, 16, -29),
    "cis": Field(4, 38, 16, -29),
    "toc": Field(4, 54, 14, 0, signed=False),  # minutes
    "af0": Field(4, 68, 31, -34),
    "af1": Field(4, 99, 21, -46),
    "af2": Field(4, 120, 6, -59),
    "group_delay": Field(5, 57, 10, -32),  # of the clock that E1 and E5b make
}
_INAV_ISSUES = tuple(Field(word, 6, 10, 0, signed=False) for word in (1, 2, 3, 4))
_INAV_HEALTH = Field(5, 69, 2, 0, signed=False)


class Subframes:
    """Collects the subframes of one satellite until an ephemeris is complete. `system`: G, J or E."""

    def __init__(self, system: str) -> None:
        self.system = system
        self.parts: dict[int, int] = {}

    def take(self, words: tuple[int, ...], time: float) -> Ephemeris | None:
        """One subframe or word as u-blox packs it -> the ephemeris, if that made it whole and the satellite is healthy.

        Args:
            words: of 32 bits.
            time: about when it came, to half a week [s of GPS time].
        """
        if self.system == "E":
            if len(words) < 8:
                return None
            # an even and an odd page of 128 bits: odd or even, nominal or alert, then 112 and 16 bits of the word
            even, odd = (joined(words[i : i + 4], 32) for i in (0, 4))
            if even >> 126 or odd >> 126 != 0b10:
                return None
            word = (even >> 14 & (1 << 112) - 1) << 16 | (odd >> 110 & 0xFFFF)
            self.parts[word >> 122] = word
            return self._ephemeris(_INAV, _INAV_ISSUES, _INAV_HEALTH, _INAV_BITS, time)
        if len(words) < 10:
            return None
        subframe = joined(tuple(word >> 6 & 0xFFFFFF for word in words[:10]), 24)
        number = subframe >> (_LNAV_BITS - 46) & 7
        if number != 4 or subframe >> (_LNAV_BITS - 56) & 63 == _KLOBUCHAR_PAGE:
            self.parts[number] = subframe
        return self._ephemeris(_LNAV, _LNAV_ISSUES, _LNAV_HEALTH, _LNAV_BITS, time) if number < 4 else None

    def klobuchar(self) -> Float[np.ndarray, "8"] | None:
        """The coefficients of the ionosphere, if GPS has sent them."""
        if self.system != "G" or 4 not in self.parts:
            return None
        return np.array([field.of(self.parts, _LNAV_BITS) for field in _KLOBUCHAR])

    def _ephemeris(
        self, fields: dict[str, Field], issues: tuple[Field, ...], health: Field, length: int, time: float
    ) -> Ephemeris | None:
        needed = {field.part for field in fields.values()}
        if not needed <= self.parts.keys() or len({issue.of(self.parts, length) for issue in issues}) > 1:
            return None
        if health.of(self.parts, length):
            return None
        result = {name: field.of(self.parts, length) for name, field in fields.items()}
        if self.system == "E":
            result["toe_of_week"], result["toc"] = 60 * result["toe_of_week"], 60 * result["toc"]
        result["toe"], result["toc"] = (nearest(result[name], time) for name in ("toe_of_week", "toc"))
        for part in issues:  # the next one is made of what comes from now on
            del self.parts[part.part]
        return Ephemeris(**result, mu=EARTH_MU[self.system], earth_rate=EARTH_RATE[self.system], tilt=0.0)
