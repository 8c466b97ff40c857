"""Ephemerides out of BeiDou's messages: D1, and D2 of geostationary satellites.

Source: BDS-SIS-ICD-B1I 3.0 (2019), figures 5-8 to 5-10 (D1) and 5-14 (D2), table 5-11. How u-blox packs them:
interface description, RXM-SFRBX (words of 30 bits, interleaved no more, below two others).
"""

import math
from dataclasses import dataclass
from itertools import accumulate
from typing import NamedTuple

from sensorfault.logs.readers.gnss.bits import Field, joined, nearest
from sensorfault.numerics.gnss.constants import EARTH_MU, EARTH_RATE
from sensorfault.numerics.gnss.kepler import Ephemeris

LATE_S = 14.0  # how far BeiDou's time is behind GPS time
_GEOSTATIONARY = {*(f"C{i:02}" for i in range(1, 6)), *(f"C{i}" for i in range(59, 64))}
_TILT = -math.radians(5)

# Bits of a subframe are counted without parity: 26 of its first word, 22 of each other.
_WORDS, _BITS = 10, 224
_NUMBER = Field(0, 15, 3, 0, signed=False)
_SECOND = Field(0, 18, 20, 0, signed=False)  # of the week
_PAGE = Field(0, 38, 4, 0, signed=False)


class _Number(NamedTuple):
    """Bits, times 2^power."""

    bits: int
    power: int = 0
    signed: bool = True
    angle: bool = False


_NUMBERS = {
    "health": _Number(1, signed=False),
    "toc": _Number(17, 3, signed=False),
    "group_delay": _Number(10),  # of B1I [0.1 ns]
    "af0": _Number(24, -33),
    "af1": _Number(22, -50),
    "af2": _Number(11, -66),
    "delta_n": _Number(16, -43, angle=True),
    "cuc": _Number(18, -31),
    "anomaly": _Number(32, -31, angle=True),
    "eccentricity": _Number(32, -33, signed=False),
    "cus": _Number(18, -31),
    "crc": _Number(18, -6),
    "crs": _Number(18, -6),
    "sqrt_a": _Number(32, -19, signed=False),
    "toe_of_week": _Number(17, 3, signed=False),
    "inclination": _Number(32, -31, angle=True),
    "cic": _Number(18, -31),
    "node_rate": _Number(24, -43, angle=True),
    "cis": _Number(18, -31),
    "inclination_rate": _Number(14, -43, angle=True),
    "node": _Number(32, -31, angle=True),
    "perigee": _Number(32, -31, angle=True),
}


@dataclass(frozen=True)
class _Message:
    """How subframes, or pages of the first subframe, make an ephemeris.

    Laid end to end from bit `start` of each to its end (`ends`, by its number), they are one row of bits in which no
    number is torn. `order`: of the numbers in that row, and so many bits of other things. `apart_s`: how long after
    each other they are sent.
    """

    ends: dict[int, int]
    start: int
    order: tuple[str | int, ...]
    apart_s: int

    @property
    def bits(self) -> int:
        return sum(end - self.start for end in self.ends.values())

    @property
    def fields(self) -> dict[str, Field]:
        sizes = [one if isinstance(one, int) else _NUMBERS[one].bits for one in self.order]
        at = accumulate(sizes, initial=0)
        return {
            one: Field(0, start, *_NUMBERS[one])
            for one, start in zip(self.order, at, strict=False)
            if isinstance(one, str)
        }


_D1 = _Message(
    {1: 224, 2: 224, 3: 224},
    38,
    (
        "health", 22, "toc", "group_delay", 74, "af2", "af0", "af1", 5,
        "delta_n", "cuc", "anomaly", "eccentricity", "cus", "crc", "crs", "sqrt_a", "toe_of_week",
        "inclination", "cic", "node_rate", "cis", "inclination_rate", "node", "perigee",
    ),
    6,
)  # fmt: skip
_D2 = _Message(
    {1: 102, 3: 108, 4: 106, 5: 106, 6: 106, 7: 106, 8: 108, 9: 106, 10: 61},
    42,
    (
        "health", 22, "toc", "group_delay", 48, "af0", "af1", "af2", 5,
        "delta_n", "cuc", "anomaly", "cus", "eccentricity", "sqrt_a", "cic", "cis", "toe_of_week",
        "inclination", "crc", "crs", "node_rate", "node", "perigee", "inclination_rate",
    ),
    3,
)  # fmt: skip


class BeidouSubframes:
    """Collects the subframes of one satellite until an ephemeris is complete. `paged`: whether it sends D2."""

    def __init__(self, paged: bool) -> None:
        self.paged, self.message = paged, _D2 if paged else _D1
        self.parts: dict[int, int] = {}
        self.began_s = -1.0

    def take(self, words: tuple[int, ...], time: float) -> Ephemeris | None:
        """One subframe as u-blox packs it -> the ephemeris, if that made it whole and the satellite is healthy.

        Args:
            words: of 32 bits.
            time: about when it came, to half a week [s of GPS time].
        """
        if len(words) < _WORDS:
            return None
        subframe = (words[0] >> 4 & (1 << 26) - 1) << 22 * 9 | joined((w >> 8 & (1 << 22) - 1 for w in words[1:10]), 22)
        number = _NUMBER.raw({0: subframe}, _BITS)
        if self.paged and number == 1:
            number = _PAGE.raw({0: subframe}, _BITS)
        elif self.paged:
            return None
        if number not in self.message.ends:
            return None
        # all of one turn: when its first was sent
        began_s = _SECOND.of({0: subframe}, _BITS) - self.message.apart_s * (number - 1)
        if began_s != self.began_s:
            self.parts, self.began_s = {}, began_s
        self.parts[number] = subframe
        return self._ephemeris(time - LATE_S) if self.parts.keys() == self.message.ends.keys() else None

    def _ephemeris(self, time: float) -> Ephemeris | None:
        """What the parts make, which are then gone; `time`: by BeiDou's clock."""
        parts, self.parts = self.parts, {}
        row = 0
        for number, end in self.message.ends.items():
            size = end - self.message.start
            row = row << size | parts[number] >> (_BITS - end) & (1 << size) - 1
        result = {name: field.of({0: row}, self.message.bits) for name, field in self.message.fields.items()}
        if result.pop("health"):
            return None
        result["group_delay"] *= 1e-10
        result["toe"], result["toc"] = (nearest(result[name], time) + LATE_S for name in ("toe_of_week", "toc"))
        return Ephemeris(**result, mu=EARTH_MU["C"], earth_rate=EARTH_RATE["C"], tilt=_TILT if self.paged else 0.0)


def tilt(satellite: str) -> float:
    """Tilt of the equator that a satellite's orbit refers to, of any system [rad]."""
    return _TILT if satellite in _GEOSTATIONARY else 0.0
