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
# A sentence may stand behind a stamp, or between commas; behind its check sum it is over.
_SENTENCE = re.compile(rb"\$[A-Z]{2}(?:GGA|RMC),[^*\r\n]*(?:\*[0-9A-Fa-f]{2})?")
_ANY = re.compile(rb"\$[A-Z]{5},")
_Sentence = tuple[time, date | None, dict[str, float]]


def read_nmea(path: Path, ask: Ask) -> Tables:
    """Place, height above the sea, speed and course, on Unix time; of a log without RMC, on the seconds of its days.

    Raises:
        LogError: no sentence GGA or RMC in it that can be read.
    """
    sentences, spoilt = _sentences(path, ask)
    first = next((day for _, day, found in sentences if day is not None), None)
    rows: dict[float, dict[str, float]] = {}
    day, last, fixed = first or _NO_DATE, 0.0, False
    for at, dated, found in sentences:
        fixed |= bool(found)
        if not fixed:
            continue  # before its first fix a receiver does not know the time
        day = dated or day
        moment = datetime.combine(day, at, UTC).timestamp()
        while first is None and moment < last - _HALF_DAY_S:
            moment += _DAY_S  # midnight
        last = moment
        rows.setdefault(moment, {}).update(found)
    if not rows:
        raise LogError(f"{path}: no sentence GGA or RMC with a fix in it that can be read; let the receiver log them.")
    damage = []
    if spoilt:
        what = f"{len(spoilt)} sentences are damaged, the first"
        damage.append(Damage(what, f"line {spoilt[0]}", "all the others were read"))
    times = list(rows)
    table = {name: np.array([rows[moment].get(name, np.nan) for moment in times]) for name in _NAMES}
    undated = f"{path.name}: there is no RMC sentence with a date; the time counts from midnight."
    notes = (undated,) if first is None else ()
    return with_notes({"": gnss_table(path, {"time": np.array(times), **table})}, notes, damage)


def _sentences(path: Path, ask: Ask) -> tuple[list[_Sentence], list[int]]:
    """The time of day, the date and the values of each sentence, and the numbers of the lines that are damaged.

    Only a receiver with a fix knows the date.
    """
    from pynmeagps import NMEAReader  # lazily: only this format needs it

    sentences: list[_Sentence] = []
    spoilt: list[int] = []
    lines = path.read_bytes().splitlines()
    for number, line in enumerate(lines, 1):
        if number % _TELL_EVERY == 0:
            ask.tell(number / len(lines))
        match = _SENTENCE.search(line)
        if match is None:
            continue
        try:
            message = NMEAReader.parse(match[0].strip() + b"\r\n")
            found = _values(message)
        except Exception:  # a damaged sentence fails in as many ways as it can be damaged
            spoilt.append(number)
            continue
        day = getattr(message, "date", None) if found else None
        if isinstance(message.time, time):
            sentences.append((message.time, day if isinstance(day, date) else None, found))
    return sentences, spoilt


def _values(message: Any) -> dict[str, float]:
    """The values of a sentence, if the receiver had a fix; empty fields have none."""
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
    """Whether a file that begins so is one: it has sentences, and no message of u-blox's own."""
    return _ANY.search(head) is not None and b"\xb5\x62" not in head


FORMAT = Format("NMEA", ("*.nmea", "*.txt", "*.log", "*.ubx"), remembering(read_nmea), looks_nmea)
