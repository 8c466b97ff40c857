"""u-blox receivers' own protocol (`.ubx`): raw measurements, what the satellites broadcast, and the receiver's fixes.

Framed here and not by pyubx2, which tests read it with for comparison: that needs 2.6 s for 1.5 MB, and where a length
is damaged it loses up to 64 kB of sound messages behind it.

Source: u-blox F9 HPG 1.32 interface description (UBX-22008968): 3.2 frame, RXM-RAWX, RXM-SFRBX, NAV-PVT.
"""

from pathlib import Path

from sensorfault.logs.readers.format import Format, remembering
from sensorfault.logs.readers.gnss.beside import NONE
from sensorfault.logs.readers.gnss.fixes import fixes
from sensorfault.logs.readers.gnss.frames import frames
from sensorfault.logs.readers.gnss.ranges import with_satellites
from sensorfault.logs.readers.gnss.ubx_broadcast import broadcast_in
from sensorfault.logs.readers.gnss.ubx_raw import measured
from sensorfault.logs.readers.source import Ask, Damage, Tables, with_notes
from sensorfault.logs.table import LogError

_RAWX, _SFRBX, _PVT = 0x0215, 0x0213, 0x0107
SATELLITES, FIXES = "RXM-RAWX", "NAV-PVT"


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
        seen = measured(raw)
        if len(seen.time):
            broadcast, notes = broadcast_in(subframes, seen), []
            if broadcast.satellites:
                seen = with_satellites(seen, broadcast)
            else:
                notes.append(f"{path.name}: no whole ephemeris was broadcast meanwhile; {NONE.split(';')[1].strip()}")
            tables[SATELLITES] = seen.table(path, notes)
    if solutions and ask.wants(FIXES):
        tables[FIXES] = fixes(path, solutions)
    if not tables and not (raw or solutions):
        raise LogError(f"{path}: no raw measurement (RXM-RAWX) and no fix (NAV-PVT) in it that can be read; log them.")
    return with_notes(tables, (), lost)


FORMAT = Format("u-blox", ("*.ubx",), remembering(read_ubx))
