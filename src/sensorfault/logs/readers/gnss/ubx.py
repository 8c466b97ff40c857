"""u-blox receivers' own protocol (`.ubx`): raw measurements, what the satellites broadcast, and the receiver's fixes.

Framed here and not by pyubx2, which tests read it with for comparison: that needs 2.6 s for 1.5 MB, and where a length
is damaged it loses up to 64 kB of sound messages behind it.

Source: u-blox F9 HPG 1.32 interface description (UBX-22008968): 3.2 frame, RXM-RAWX, RXM-SFRBX, NAV-PVT.
"""

import struct
from collections import defaultdict
from pathlib import Path

import numpy as np

from sensorfault.logs.readers.gnss.beside import NONE
from sensorfault.logs.readers.gnss.broadcast import Broadcast, gathered
from sensorfault.logs.readers.gnss.fixes import fixes
from sensorfault.logs.readers.gnss.frames import frames
from sensorfault.logs.readers.gnss.observed import Observed, name_of, observed
from sensorfault.logs.readers.gnss.ranges import with_satellites
from sensorfault.logs.readers.gnss.subframes import Subframes
from sensorfault.logs.readers.source import Ask, Damage, Tables, told
from sensorfault.logs.table import LogError
from sensorfault.numerics.gnss.constants import WEEK_S
from sensorfault.numerics.gnss.kepler import Ephemeris

_RAWX, _SFRBX, _PVT = 0x0215, 0x0213, 0x0107
SATELLITES, FIXES = "RXM-RAWX", "NAV-PVT"
_SYSTEMS = {0: "G", 1: "S", 2: "E", 3: "C", 5: "J", 6: "R"}
_FIRST = {"G": (0,), "S": (0,), "E": (0, 1), "C": (0, 1), "J": (0,), "R": (0,)}  # signals on the first frequency
_NAVIGATION = {"G": (0,), "J": (0,), "E": (0, 1, 5)}  # signals that bear what Subframes reads
_NO_NUMBER = 255  # of a GLONASS satellite that is not known yet
_MEASUREMENT = np.dtype(
    [
        ("pseudorange", "<f8"), ("phase", "<f8"), ("doppler", "<f4"), ("system", "u1"), ("satellite", "u1"),
        ("signal", "u1"), ("slot", "u1"), ("lock", "<u2"), ("cn0", "u1"), ("sigma", "u1"), ("phase_sigma", "u1"),
        ("doppler_sigma", "u1"), ("status", "u1"), ("reserved", "u1"),
    ]
)  # fmt: skip
_HEAD = struct.Struct("<dHbBBBH")


def read_ubx(path: Path, ask: Ask) -> Tables:
    """Table `RXM-RAWX`: each satellite's first frequency, its place by what it broadcast meanwhile; `NAV-PVT`: fixes.

    Raises:
        LogError: no message of the two kinds in it that can be read.
    """
    raw, subframes, solutions = [], [], []
    lost: list[Damage] = []
    for kind, payload in frames(path, lost, ask.tell):
        if kind == _RAWX:
            raw.append(payload)
        elif kind == _SFRBX:
            subframes.append((len(raw), payload))
        elif kind == _PVT and len(payload) >= 68:
            solutions.append(payload)
    tables: Tables = {}
    if raw and ask.wants(SATELLITES):
        seen, times = _observed(raw)
        if len(seen.time):
            broadcast, notes = _broadcast(path, subframes, times), []
            if broadcast.satellites:
                seen = with_satellites(seen, broadcast)
            else:
                notes.append(f"{path.name}: no whole ephemeris was broadcast meanwhile; {NONE.split(';')[1].strip()}")
            tables[SATELLITES] = seen.table(path, notes)
    if solutions and ask.wants(FIXES):
        tables[FIXES] = fixes(path, solutions)
    if not tables and not (raw or solutions):
        raise LogError(f"{path}: no raw measurement (RXM-RAWX) and no fix (NAV-PVT) in it that can be read; log them.")
    return told(tables, (), lost)


def _observed(raw: list[bytes]) -> tuple[Observed, list[float]]:
    """The measurements, and the time of each epoch [s of GPS time]; an epoch that is no whole one has none."""
    times: list[float] = []
    names: dict[str, int] = {}
    epoch, satellite = [], []
    values: dict[str, list[float]] = defaultdict(list)
    for payload in raw:
        head = _HEAD.unpack_from(payload) if len(payload) >= _HEAD.size else None
        if head is None or not 0 <= head[0] < WEEK_S or len(payload) < _HEAD.size + head[3] * _MEASUREMENT.itemsize:
            continue
        if times and times[-1] >= head[1] * WEEK_S + head[0]:
            continue
        for one in np.frombuffer(payload, _MEASUREMENT, head[3], _HEAD.size):
            system = _SYSTEMS.get(int(one["system"]), "")
            if (
                int(one["signal"]) not in _FIRST.get(system, ())
                or one["satellite"] == _NO_NUMBER
                or not one["status"] & 1
            ):
                continue
            epoch.append(len(times))
            satellite.append(names.setdefault(name_of(system, int(one["satellite"])), len(names)))
            values["pseudorange_m"].append(float(one["pseudorange"]))
            values["doppler_hz"].append(float(one["doppler"]))
            values["cn0_dbhz"].append(float(one["cn0"]))
            values["sigma_m"].append(0.01 * 2.0 ** (int(one["sigma"]) & 15))  # σ = 0.01 · 2ⁿ m
        times.append(head[1] * WEEK_S + head[0])
    return observed(times, list(names), epoch, satellite, values), times


def _broadcast(path: Path, subframes: list[tuple[int, bytes]], times: list[float]) -> Broadcast:
    """The ephemerides in the subframes; `subframes`: how many epochs had been before each, and its payload."""
    gather: dict[str, Subframes] = {}
    orbits: dict[str, list[Ephemeris]] = defaultdict(list)
    for before, payload in subframes:
        if len(payload) < 8 or len(payload) < 8 + 4 * payload[4]:
            continue
        system = _SYSTEMS.get(payload[0], "")
        if payload[2] in _NAVIGATION.get(system, ()):
            name = f"{system}{payload[1]:02}"
            one = gather.setdefault(f"{name}.{payload[2]}", Subframes(system))
            found = one.take(struct.unpack_from(f"<{payload[4]}I", payload, 8), times[min(before, len(times) - 1)])
            if found is not None and found.toe not in [other.toe for other in orbits[name]]:
                orbits[name].append(found)
    klobuchar = next((told for one in gather.values() if (told := one.klobuchar()) is not None), None)
    return gathered({name: each for name, each in orbits.items() if each}, {}, klobuchar)
