"""u-blox's RXM-SFRBX: what satellites broadcast about themselves."""

import struct
from collections import defaultdict

from sensorfault.logs.readers.gnss.beidou import BeidouSubframes
from sensorfault.logs.readers.gnss.broadcast import Broadcast, gathered
from sensorfault.logs.readers.gnss.glonass import GlonassStrings
from sensorfault.logs.readers.gnss.observed import Observed, name_of
from sensorfault.logs.readers.gnss.subframes import Subframes
from sensorfault.logs.readers.gnss.ubx_raw import SYSTEMS
from sensorfault.numerics.gnss.glonass import GlonassEphemeris
from sensorfault.numerics.gnss.kepler import Ephemeris

_Gather = Subframes | BeidouSubframes | GlonassStrings


def broadcast_in(subframes: list[tuple[int, bytes]], seen: Observed) -> Broadcast:
    """The ephemerides in the subframes; `subframes`: how many epochs had been before each, and its payload."""
    gather: dict[tuple[str, int], _Gather | None] = {}
    orbits: dict[str, dict[float, Ephemeris]] = defaultdict(
        dict
    )  # by reference time: of those that come again the first
    states: dict[str, dict[float, GlonassEphemeris]] = defaultdict(dict)
    for before, payload in subframes:
        if len(payload) < 8 or len(payload) < 8 + 4 * payload[4]:
            continue
        system, signal = SYSTEMS.get(payload[0], ""), payload[2]
        name = name_of(system, payload[1])
        if (name, signal) not in gather:
            gather[name, signal] = _gather(system, signal)
        one = gather[name, signal]
        if one is None:
            continue
        time = seen.time[min(before, len(seen.time) - 1)]
        found = one.take(struct.unpack_from(f"<{payload[4]}I", payload, 8), float(time))
        if isinstance(found, GlonassEphemeris):
            states[name].setdefault(found.toe, found)
        elif found is not None:
            # BeiDou tells the delay of B1I against B3I, by which its clocks are
            orbits[name].setdefault(found.toe, found._replace(group_delay=0.0) if system in seen.frequency else found)
    klobuchar = next(
        (result for one in gather.values() if isinstance(one, Subframes) and (result := one.klobuchar()) is not None),
        None,
    )
    return gathered(
        {name: list(each.values()) for name, each in orbits.items()},
        {name: list(each.values()) for name, each in states.items()},
        klobuchar,
    )


def _gather(system: str, signal: int) -> _Gather | None:
    """What reads the message on a signal; nothing, if that bears another."""
    if (system, signal) in {("G", 0), ("J", 0), ("E", 0), ("E", 1), ("E", 5)}:
        return Subframes(system)
    if system == "C" and signal in (0, 2, 4, 1, 3, 10):  # B1I, B2I and B3I, with D1 and with D2
        return BeidouSubframes(paged=signal in (1, 3, 10))
    if system == "R" and signal in (0, 2):
        return GlonassStrings()
    return None
