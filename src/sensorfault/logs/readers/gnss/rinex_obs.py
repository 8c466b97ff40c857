"""RINEX 2 and 3 observation files: what a receiver measured of each satellite.

By fixed columns, in one pass.

Source: RINEX 2.11 (Gurtner, 2007), table A2; RINEX 3.04 (IGS/RTCM, 2018), tables 4 to 10, A2 and A3.
"""

from collections import defaultdict
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from typing import NamedTuple

from sensorfault.logs.readers.format import Format, one_table, remembering
from sensorfault.logs.readers.gnss.beside import broadcast_beside
from sensorfault.logs.readers.gnss.observed import Observed, observed
from sensorfault.logs.readers.gnss.ranges import with_satellites
from sensorfault.logs.readers.gnss.rinex import Header, calendar_s, lines_of, looks_rinex, read_header
from sensorfault.logs.readers.gps_time import GPS_EPOCH_S
from sensorfault.logs.readers.source import Damage, Source
from sensorfault.logs.table import LogError

_WIDTH = 16  # of one observation: 14.3 and two digits
_NAMES = {"C": "pseudorange_m", "D": "doppler_hz", "S": "cn0_dbhz"}
_FIRST = {"C": "2"}  # BeiDou calls its first frequency 2; version 3.02 calls it 1
_SYSTEMS = "GREJCIS"


class _Epoch(NamedTuple):
    """`rows`: of each satellite, its name and the line of its observations."""

    time: float  # [s of GPS time]
    line: int
    rows: list[tuple[str, str]]


def read_obs(path: Path) -> Source:
    """Pseudorange, Doppler and C/N0 of the first frequency for each satellite: `G07.pseudorange_m` and so on.

    Where navigation files lie beside it, the satellites' places and corrected ranges too (see `ranges`).

    Raises:
        LogError: no observation file, or no epoch in it that can be read.
    """
    lines = lines_of(path)
    header = read_header(path, lines)
    if header.kind != "O":
        raise LogError(
            f"{path}: this RINEX file holds no observations (its type is '{header.kind}'); name one of type O."
        )
    damage: list[Damage] = []
    epochs = _epochs_2(lines, header, damage) if header.version < 3 else _epochs_3(lines, header, damage)
    seen = _gathered(epochs, header, damage)
    if not len(seen.time):
        raise LogError(f"{path}: no epoch below the header can be read; convert the log again.")
    broadcast, notes = broadcast_beside(path, float(seen.time[0]))
    if broadcast is not None:
        seen = with_satellites(seen, broadcast)
    return seen.table(path, notes, damage)


def _gathered(epochs: Iterator[_Epoch], header: Header, damage: list[Damage]) -> Observed:
    times: list[float] = []
    satellites: dict[str, int] = {}
    which: list[int] = []
    whom: list[int] = []
    values: dict[str, list[float]] = defaultdict(list)
    spoilt: list[int] = []
    columns = {system: _columns(header, system) for system in _SYSTEMS}
    for epoch in epochs:
        for name, line in epoch.rows:
            start = columns.get(name[:1])
            if not start:
                continue
            try:
                found = {value: _number(line[at : at + 14]) for value, at in start.items()}
            except ValueError:
                spoilt.append(epoch.line)
                continue
            if found.get("pseudorange_m", 0.0) == found.get("pseudorange_m", 0.0):
                which.append(len(times))
                whom.append(satellites.setdefault(name, len(satellites)))
                for value in _NAMES.values():
                    values[value].append(found.get(value, float("nan")))
        times.append(epoch.time)
    if spoilt:
        what = f"{len(spoilt)} observations cannot be read, the first"
        damage.append(Damage(what, f"the epoch of line {spoilt[0]}", "they were left out"))
    return observed(times, list(satellites), which, whom, values)


def _number(text: str) -> float:
    """An observation; blank or 0 says that there is none."""
    return float(text) or float("nan") if text.strip() else float("nan")


def _columns(header: Header, system: str) -> dict[str, int]:
    """Where the first frequency's observations begin in a satellite's line."""
    codes = header.codes.get("" if header.version < 3 else system, ())
    found: dict[str, int] = {}
    if header.version < 3:
        for kind, name in _NAMES.items():
            wanted = next((code for code in (f"{kind}1", "P1" if kind == "C" else "") if code in codes), None)
            if wanted is not None:
                found[name] = _WIDTH * codes.index(wanted)
        return found
    ranges = [code for code in codes if code.startswith("C")]
    first = next((code for code in ranges if code[1:2] == _FIRST.get(system, "1")), ranges[0] if ranges else None)
    if first is None:
        return {}
    own = {name: f"{kind}{first[1:]}" for kind, name in _NAMES.items()}
    return {name: 3 + _WIDTH * codes.index(code) for name, code in own.items() if code in codes}


def _flag_and_count(flag: str, count: str) -> tuple[int, int]:
    """The lines of an epoch, from its first line."""
    if int(count) < 0:
        raise ValueError("no count")
    return int(flag), int(count)


def _epochs_3(lines: list[str], header: Header, damage: list[Damage]) -> Iterator[_Epoch]:
    at = header.lines
    while at < len(lines):
        head = lines[at]
        if not head.strip():  # as at the end of many files
            at += 1
            continue
        try:
            if not head.startswith(">"):
                raise ValueError("no epoch")
            flag, count = _flag_and_count(head[29:32], head[32:35])
            time = calendar_s(head[1:29].split()) - GPS_EPOCH_S + header.behind_s if flag < 2 else 0.0
        except (ValueError, IndexError):
            damage.append(Damage("no epoch can be read", f"line {at + 1}", "the search continued at the next"))
            at = next((i for i in range(at + 1, len(lines)) if lines[i].startswith(">")), len(lines))
            continue
        body = lines[at + 1 : at + 1 + count]
        if len(body) < count:
            damage.append(Damage("the file breaks off", f"line {len(lines)}"))
            return
        if flag < 2:
            yield _Epoch(time, at + 1, [(line[:3].replace(" ", "0"), line) for line in body])
        at += 1 + count


def _epochs_2(lines: list[str], header: Header, damage: list[Damage]) -> Iterator[_Epoch]:
    at, each = header.lines, -(-len(header.codes.get("", ())) // 5)
    while at < len(lines):
        head = lines[at]
        if not head.strip():  # as at the end of many files
            at += 1
            continue
        try:
            flag, count = _flag_and_count(head[26:29], head[29:32])
            time = calendar_s(head[:26].split()) - GPS_EPOCH_S + header.behind_s if flag < 2 else 0.0
        except (ValueError, IndexError):
            damage.append(Damage("no epoch can be read", f"line {at + 1}", "what came before was read"))
            return
        if flag > 1:
            at += 1 + count
            continue
        heads = max(1, -(-count // 12))
        end = at + heads + count * each
        if end > len(lines):
            damage.append(Damage("the file breaks off", f"line {len(lines)}"))
            return
        listed = "".join(line[32:68].ljust(36) for line in lines[at : at + heads])
        names = [listed[3 * i : 3 * i + 3] for i in range(count)]
        body = [
            "".join(line[:80].ljust(80) for line in lines[i : i + each]) for i in range(at + heads, end, max(each, 1))
        ]
        named = [(("G" if name[0] == " " else name[0]) + name[1:].replace(" ", "0")) for name in names]
        yield _Epoch(time, at + 1, list(zip(named, body, strict=False)))
        at = end


FORMAT = Format(
    "RINEX observations",
    ("*.obs", "*.rnx", "*.[0-9][0-9]o"),
    remembering(one_table(read_obs)),
    partial(looks_rinex, "O"),
    priority=1,
)
