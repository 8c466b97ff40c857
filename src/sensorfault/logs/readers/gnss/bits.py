"""Numbers in the bits that satellites send."""

import math
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from sensorfault.numerics.gnss.constants import WEEK_S


class Field(NamedTuple):
    """A number of so many bits: in which part of the message, where it begins, times 2^power; angles in semicircles."""

    part: int
    start: int
    bits: int
    power: int
    signed: bool = True
    angle: bool = False

    def of(self, parts: Mapping[int, int], length: int) -> float:
        """Its value, of two's complement where it has a sign; `length`: bits of a part."""
        raw = self.raw(parts, length)
        if self.signed and raw >> (self.bits - 1):
            raw -= 1 << self.bits
        return math.ldexp(raw, self.power) * (math.pi if self.angle else 1.0)

    def raw(self, parts: Mapping[int, int], length: int) -> int:
        """Its bits as they stand."""
        return parts[self.part] >> (length - self.start - self.bits) & (1 << self.bits) - 1


def joined(words: Iterable[int], bits: int) -> int:
    """Words of so many bits, one after the other."""
    row = 0
    for word in words:
        row = row << bits | word
    return row


def nearest(of_period: float, time: float, period_s: float = WEEK_S) -> float:
    """The time of a week, or of another period, in that which brings it nearest to a time [s]."""
    return of_period + round((time - of_period) / period_s) * period_s
