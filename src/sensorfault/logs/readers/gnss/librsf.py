"""libRSF's text files, as smartLoc and others come in: one measurement a line, its first word says of what.

Source: smartLoc's readme (TU Chemnitz, 2022). Its pseudoranges are corrected for the satellites' clocks and the air,
not for the earth's turn.
"""

import math
from collections import Counter, defaultdict
from pathlib import Path

import numpy as np
import polars as pl

from sensorfault.logs.entries import ChannelEntry, SensorEntry
from sensorfault.logs.readers.format import Format, remembering
from sensorfault.logs.readers.gnss.observed import TIME, observed
from sensorfault.logs.readers.gnss.rinex import lines_of
from sensorfault.logs.readers.source import Ask, Damage, Source, Tables, with_notes
from sensorfault.logs.table import LogError

_SYSTEMS = {1: "G", 2: "S", 4: "R", 8: "E", 16: "J", 32: "C"}
_RANGES = "pseudorange3"
_WORDS = {  # name and unit of the numbers behind the time; "" is left out
    _RANGES: (),
    "odom3": (
        *((f"velocity_{axis}", "m/s") for axis in "xyz"),
        *((f"turn_rate_{axis}", "rad/s") for axis in "xyz"),
    ),
    "point3": tuple((f"position_{axis}", "m") for axis in "xyz"),
}
_SENSOR = {"velocity": "odometry", "turn_rate": "gyro", "position": "position"}


def read_librsf(path: Path, ask: Ask) -> Tables:
    """A table for each kind of measurement: `pseudorange3` by satellite, `odom3` and `point3`.

    Raises:
        LogError: no line in it that can be read.
    """
    rows: dict[str, list[list[float]]] = defaultdict(list)
    spoilt: list[int] = []
    others: Counter[str] = Counter()
    for number, line in enumerate(lines_of(path), 1):
        word, *cells = line.split() or [""]
        if word not in _WORDS:
            others[word] += bool(word)
            continue
        try:
            found = [float(cell) for cell in cells]
        except ValueError:
            found = []
        if not all(map(math.isfinite, found)) or len(found) < (10 if word == _RANGES else 1 + len(_WORDS[word])):
            spoilt.append(number)
        else:
            rows[word].append(found)
    if not rows:
        raise LogError(f"{path}: no line begins with {', '.join(_WORDS)}; name a file of libRSF's.")
    damage = []
    if spoilt:
        what = f"{len(spoilt)} lines cannot be read, the first"
        damage.append(Damage(what, f"line {spoilt[0]}", "they were left out"))
    left = ", ".join(f"{word} ({count})" for word, count in others.items() if word)
    notes = [f"{path.name}: lines of another kind were left out: {left}."] if left else []
    tables = {word: _ranges(path, each) if word == _RANGES else _plain(path, word, each) for word, each in rows.items()}
    return with_notes({word: table for word, table in tables.items() if ask.wants(word)}, notes, damage)


def _plain(path: Path, word: str, rows: list[list[float]]) -> Source:
    names = _WORDS[word]
    value = np.array([row[: 1 + len(names)] for row in rows])
    columns = {TIME: value[:, 0], **{name: value[:, 1 + i] for i, (name, _) in enumerate(names)}}
    sensors = []
    for stem, sensor in _SENSOR.items():
        moving = [
            ChannelEntry(name[-1], name, unit, watch=stem != "position")
            for name, unit in names
            if name.startswith(stem) and np.ptp(columns[name]) > 0
        ]
        if moving:
            sensors.append(SensorEntry(sensor, tuple(moving)))
    frame = pl.DataFrame({name: np.ascontiguousarray(column) for name, column in columns.items()})
    return Source(path, frame, TIME, "s", sensors=tuple(sensors))


def _ranges(path: Path, rows: list[list[float]]) -> Source:
    epochs = sorted({row[0] for row in rows})
    epoch = {time: i for i, time in enumerate(epochs)}
    names: dict[str, int] = {}
    whom = [names.setdefault(_name(int(row[6]), int(row[7])), len(names)) for row in rows]
    values = {
        "corrected_m": [row[1] for row in rows],
        "sigma_m": [max(row[2], 0.0) ** 0.5 for row in rows],
        **{f"{axis}_m": [row[3 + i] for row in rows] for i, axis in enumerate("xyz")},
        "elevation_rad": [float(np.deg2rad(row[8])) for row in rows],
        "cn0_dbhz": [row[9] for row in rows],
    }
    seen = observed(epochs, list(names), [epoch[row[0]] for row in rows], whom, values)
    return seen.table(path, gps_time=False)


def _name(satellite: int, system: int) -> str:
    """`R20` is told as 320 of system 4, or as 352, NMEA's way of counting GLONASS from 33."""
    letter, number = _SYSTEMS.get(system, "X"), satellite % 100
    return f"{letter}{number - 32 if letter == 'R' and number > 32 else number:02}"


def looks_librsf(head: bytes) -> bool:
    """Whether a file that begins so is one."""
    return (head.split(maxsplit=1) or [b""])[0].decode("ascii", "replace") in _WORDS


FORMAT = Format("libRSF measurements", ("*.txt",), remembering(read_librsf), looks_librsf, priority=1)
