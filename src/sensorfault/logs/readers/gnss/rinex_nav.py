"""RINEX 2 and 3 navigation files: the ephemerides that satellites broadcast.

Source: RINEX 2.11 (Gurtner, 2007), tables A3, A4, A10; RINEX 3.04 (IGS/RTCM, 2018), tables A4 to A14.
"""

from collections import defaultdict
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from sensorfault.logs.readers.format import Format, one_table, remembering
from sensorfault.logs.readers.gnss.beidou import LATE_S, tilt
from sensorfault.logs.readers.gnss.broadcast import Broadcast, gathered
from sensorfault.logs.readers.gnss.leader import observations_beside
from sensorfault.logs.readers.gnss.observed import Observed
from sensorfault.logs.readers.gnss.rinex import Header, calendar_s, lines_of, looks_rinex, read_header
from sensorfault.logs.readers.gps_time import GPS_EPOCH_S, leap_seconds
from sensorfault.logs.readers.source import Damage, Source
from sensorfault.logs.table import LogError
from sensorfault.numerics.gnss.constants import EARTH_MU, EARTH_RATE, WEEK_S
from sensorfault.numerics.gnss.glonass import GlonassEphemeris
from sensorfault.numerics.gnss.kepler import Ephemeris

_LINES = {"R": 4, "S": 4}  # a record has eight lines else
_WIDTH = 19
_EVERY_S, _DAY_S = 300.0, 86_400.0
_BEIDOU_WEEK = 1356  # its week 0


def read_nav(path: Path) -> Broadcast:
    """The healthy satellites' ephemerides; SBAS and records that are cut off are left out.

    Raises:
        LogError: no navigation file, or no ephemeris in it.
    """
    lines = lines_of(path)
    header = read_header(path, lines)
    if header.kind not in "NG":
        raise LogError(
            f"{path}: this RINEX file holds no ephemerides (its type is '{header.kind}'); name one of type N."
        )
    orbits: dict[str, list[Ephemeris]] = defaultdict(list)
    states: dict[str, list[GlonassEphemeris]] = defaultdict(list)
    lost: list[int] = []
    for satellite, epoch, fields in _records(lines, header, lost):
        if satellite[0] == "R":
            if fields[6] == 0:
                states[satellite].append(_state(epoch, fields))
        elif satellite[0] in EARTH_MU and fields[24] == 0:
            orbits[satellite].append(_orbit(satellite, epoch, fields))
    found = gathered(orbits, states, header.klobuchar)
    if not found.satellites:
        raise LogError(f"{path}: no ephemeris of a healthy satellite below its header; take the file of another day.")
    if lost:
        what = f"{len(lost)} ephemerides cannot be read, the first"
        found = replace(found, damage=(Damage(what, f"line {lost[0]}", "all the others were read"),))
    return found


def read_places(path: Path) -> Source:
    """Where the satellites of a navigation file were, every five minutes as far as its ephemerides reach.

    Raises:
        LogError: no navigation file, or no ephemeris in it.
    """
    broadcast = read_nav(path)
    usual = np.sort(broadcast.times)[len(broadcast.times) // 2]  # a file of a day may hold another week's
    near = broadcast.times[np.abs(broadcast.times - usual) <= _DAY_S]
    times = np.arange(near.min(), near.max() + 1, _EVERY_S)
    each = [broadcast.at(name, times) for name in broadcast.satellites]
    places = np.stack([one.position for one in each], axis=1)
    value = {f"{axis}_m": places[..., k] for k, axis in enumerate("xyz")}
    value["clock_s"] = np.stack([one.clock for one in each], axis=1)
    return Observed(times, broadcast.satellites, value).table(path, damage=broadcast.damage)


def _records(lines: list[str], header: Header, lost: list[int]) -> Iterator[tuple[str, float, list[float]]]:
    """Satellite, its epoch as if UTC [s since 1970] and the numbers of each record; `lost`: lines of those damaged."""
    old = header.version < 3
    head, start = (22, slice(0, 2)) if old else (23, slice(0, 3))
    begins = [i for i in range(header.lines, len(lines)) if lines[i][start].strip()]
    for at, end in zip(begins, [*begins[1:], len(lines)], strict=False):
        letter = ("R" if header.kind == "G" else "G") if old else ""
        name = (letter + lines[at][start]).replace(" ", "0")
        count = _LINES.get(name[0], 8) + (name[0] == "R" and header.version >= 3.05)
        record = lines[at : min(at + count, end)]
        try:
            epoch = calendar_s(record[0][start.stop : head].split())
            numbers = [_number(record[0], head + _WIDTH * i) for i in range(3)]
            for line in record[1:]:
                numbers += [_number(line, head - _WIDTH + _WIDTH * i) for i in range(4)]
        except (ValueError, IndexError):
            lost.append(at + 1)
            continue
        if len(record) < count:
            lost.append(at + 1)
        else:
            yield name, epoch, numbers


def _number(line: str, start: int) -> float:
    text = line[start : start + _WIDTH].strip()
    return float(text.replace("D", "E").replace("d", "e")) if text else 0.0


def _orbit(satellite: str, epoch: float, fields: list[float]) -> Ephemeris:
    """A record of Kepler's kind; its first three numbers are the clock's."""
    system = satellite[0]
    late = LATE_S if system == "C" else 0.0
    week = fields[21] + (_BEIDOU_WEEK if system == "C" else 0)
    return Ephemeris(
        toe=week * WEEK_S + fields[11] + late,
        toc=epoch - GPS_EPOCH_S + late,
        af0=fields[0],
        af1=fields[1],
        af2=fields[2],
        group_delay=_group_delay(system, fields),
        crs=fields[4],
        delta_n=fields[5],
        anomaly=fields[6],
        cuc=fields[7],
        eccentricity=fields[8],
        cus=fields[9],
        sqrt_a=fields[10],
        toe_of_week=fields[11],
        cic=fields[12],
        node=fields[13],
        cis=fields[14],
        inclination=fields[15],
        crc=fields[16],
        perigee=fields[17],
        node_rate=fields[18],
        inclination_rate=fields[19],
        mu=EARTH_MU[system],
        earth_rate=EARTH_RATE[system],
        tilt=tilt(satellite),
    )


def _group_delay(system: str, fields: list[float]) -> float:
    """Of the first frequency [s]. Galileo has one for the clock that E1 and E5a make, and one for E1 and E5b."""
    of_e5b = int(fields[20]) & 0b101 or not fields[20]
    return fields[26] if system == "E" and of_e5b else fields[25]


def _state(epoch: float, fields: list[float]) -> GlonassEphemeris:
    """A record of GLONASS: kilometres, and times in UTC."""
    return GlonassEphemeris(
        toe=epoch - GPS_EPOCH_S + leap_seconds(epoch),
        offset=fields[0],
        drift=fields[1],
        start=[1e3 * fields[i] for i in (3, 7, 11)],
        speed=[1e3 * fields[i] for i in (4, 8, 12)],
        pull=[1e3 * fields[i] for i in (5, 9, 13)],
    )


FORMAT = Format(
    "RINEX navigation",
    ("*.nav", "*.rnx", "*.[0-9][0-9][nglp]"),
    remembering(one_table(read_places)),
    partial(looks_rinex, "NG"),
    observations_beside,
)
