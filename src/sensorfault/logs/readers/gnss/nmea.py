"""NMEA 0183 sentences of a receiver, by pynmeagps: GGA and RMC become one row for each time."""

import re
from datetime import UTC, date, datetime, time
from pathlib import Path
from typing import Any

import numpy as np

from sensorfault.logs.readers.format import Format, remembering
from sensorfault.logs.readers.gnss.fixes import gnss_table
from sensorfault.logs.readers.source import Ask, Damage, Tables, with_notes
from sensorfault.logs.table import LogError
from sensorfault.logs.units import KNOT

_NAMES = ("latitude", "longitude", "altitude", "speed", "course")
_NO_DATE = date(1970, 1, 1)
_DAY_S, _HALF_DAY_S = 86_400.0, 43_200.0
_TELL_EVERY = 10_000


def read_nmea(path: Path, ask: Ask) -> Tables:
    """Place, height above the sea, speed and course, on Unix time; of a log without RMC, on the seconds of its days.

    Raises:
        LogError: no sentence GGA or RMC in it that can be read.
    """
    from pynmeagps import NMEAReader  # lazily: only this format needs it

    rows: dict[float, dict[str, float]] = {}
    spoilt: list[int] = []
    day, dated, last = _NO_DATE, False, 0.0
    lines = path.read_bytes().splitlines()
    for number, line in enumerate(lines, 1):
        if number % _TELL_EVERY == 0:
            ask.tell(number / len(lines))
        if line[:1] != b"$" or line[3:6] not in (b"GGA", b"RMC"):
            continue
        try:
            message = NMEAReader.parse(line + b"\r\n")
            at, told_day = message.time, getattr(message, "date", None)
            if isinstance(told_day, date):
                day, dated = told_day, True
            if not isinstance(at, time):
                continue
            found = _values(message)
        except Exception:  # a damaged sentence fails in as many ways as it can be damaged
            spoilt.append(number)
            continue
        moment = datetime.combine(day, at, UTC).timestamp()
        while not dated and moment < last - _HALF_DAY_S:
            moment += _DAY_S  # midnight
        last = moment
        rows.setdefault(moment, {}).update(found)
    if not rows:
        raise LogError(f"{path}: no sentence GGA or RMC in it that can be read; let the receiver log them.")
    damage = []
    if spoilt:
        what = f"{len(spoilt)} sentences are damaged, the first"
        damage.append(Damage(what, f"line {spoilt[0]}", "all the others were read"))
    times = [moment for moment in rows if not dated or moment > _DAY_S]
    table = {name: np.array([rows[moment].get(name, np.nan) for moment in times]) for name in _NAMES}
    notes = () if dated else (f"{path.name}: no sentence RMC tells the date; the time counts from midnight.",)
    return with_notes({"": gnss_table(path, {"time": np.array(times), **table})}, notes, damage)


def _values(message: Any) -> dict[str, float]:
    """What a sentence tells, if the receiver had a fix; empty fields tell nothing."""
    if message.msgID == "RMC":
        if message.status != "A":
            return {}
        result = {"latitude": message.lat, "longitude": message.lon, "speed": message.spd, "course": message.cog}
    elif not message.quality:
        return {}
    else:
        result = {"latitude": message.lat, "longitude": message.lon, "altitude": message.alt}
    numbers = {name: float(value) for name, value in result.items() if value != ""}
    if "speed" in numbers:
        numbers["speed"] *= KNOT
    return numbers


def looks_nmea(head: bytes) -> bool:
    """Whether a file that begins so is one: its first whole lines are sentences."""
    lines = head.splitlines()[:-1]
    return any(re.match(rb"\$[A-Z]{5},", line) for line in lines[:10])


FORMAT = Format("NMEA", ("*.nmea", "*.txt", "*.log"), remembering(read_nmea), looks_nmea)
