"""States out of the strings that GLONASS sends.

Source: GLONASS ICD, edition 5.1 (2008), tables 4.5 and 4.6, figure 4.3. How u-blox packs them: interface description,
RXM-SFRBX (bits 85 to 1, the eleven that follow, and a word of the superframe and the frame).
"""

import math

from sensorfault.logs.readers.gnss.bits import Field, joined, nearest
from sensorfault.logs.readers.gps_time import GPS_EPOCH_S, leap_seconds
from sensorfault.numerics.gnss.glonass import GlonassEphemeris

_BITS, _WORDS = 85, 4
_DAY_S, _MOSCOW_S = 86_400.0, 10_800.0
_UNUSED = 11  # bits behind the last


def _field(part: int, last: int, first: int, power: int, signed: bool = True) -> Field:
    """By the document's numbers: bit 85 is sent first."""
    return Field(part, _BITS - last, last - first + 1, power, signed)


_STRING = _field(0, 84, 81, 0, signed=False)
_PLACE = tuple(_field(string, 35, 9, -11) for string in (1, 2, 3))  # [km]
_SPEED = tuple(_field(string, 64, 41, -20) for string in (1, 2, 3))  # [km/s]
_PULL = tuple(_field(string, 40, 36, -30) for string in (1, 2, 3))  # [km/s²]
_QUARTER = _field(2, 76, 70, 0, signed=False)  # tb, quarters of an hour of Moscow's day
_ILL = (_field(2, 80, 80, 0, signed=False), _field(3, 65, 65, 0, signed=False))  # the first bit of Bn, and ln
_DRIFT = _field(3, 79, 69, -40)  # γn
_OFFSET = _field(4, 80, 59, -30)  # τn


class GlonassStrings:
    """Collects the strings of one satellite until a state is complete."""

    def __init__(self) -> None:
        self.parts: dict[int, int] = {}
        self.frame = -1

    def take(self, words: tuple[int, ...], time: float) -> GlonassEphemeris | None:
        """One string as u-blox packs it -> the state, if that made it whole and the satellite is healthy.

        Args:
            words: of 32 bits.
            time: about when it came, to half a day [s of GPS time].
        """
        if len(words) < _WORDS:
            return None
        string = joined(words[:3], 32) >> _UNUSED
        number = _STRING.raw({0: string}, _BITS)
        if not 1 <= number <= 4:
            return None
        if words[3] != self.frame:
            self.parts, self.frame = {}, words[3]
        self.parts[number] = string
        return self._state(time) if len(self.parts) == 4 else None

    def _state(self, time: float) -> GlonassEphemeris | None:
        """What the strings make, which are then gone."""
        parts, self.parts = self.parts, {}
        if any(ill.of(parts, _BITS) for ill in _ILL):
            return None
        late = leap_seconds(GPS_EPOCH_S + time)
        moscow_s = time - late + _MOSCOW_S
        return GlonassEphemeris(
            toe=nearest(900 * _number(_QUARTER, parts), moscow_s, _DAY_S) - _MOSCOW_S + late,
            offset=-_number(_OFFSET, parts),
            drift=_number(_DRIFT, parts),
            start=[1e3 * _number(one, parts) for one in _PLACE],
            speed=[1e3 * _number(one, parts) for one in _SPEED],
            pull=[1e3 * _number(one, parts) for one in _PULL],
        )


def _number(field: Field, parts: dict[int, int]) -> float:
    """Its value, of a sign and a size."""
    raw = field.raw(parts, _BITS)
    size = 1 << (field.bits - 1) if field.signed else 1 << field.bits
    return math.ldexp(raw % size, field.power) * (-1 if raw >= size else 1)
