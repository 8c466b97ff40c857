"""The ephemerides that lie beside an observation file."""

from pathlib import Path

import numpy as np

from sensorfault.logs.readers.gnss.broadcast import Broadcast
from sensorfault.logs.readers.gnss.rinex import looks_rinex
from sensorfault.logs.readers.gnss.rinex_nav import read_nav
from sensorfault.logs.table import LogError

_REACH_S = 7_200.0
NONE = (
    "no navigation file (RINEX type N) of its day is beside it; satellite positions and corrected ranges are left out."
)


def broadcast_beside(path: Path, time: float) -> tuple[Broadcast | None, list[str]]:
    """The ephemerides in the same folder for a time [s of GPS time], and notes on the files."""
    found, used, notes = Broadcast(), [], []
    for file in sorted(path.parent.iterdir()):
        if file == path or not file.is_file() or not _is_nav(file):
            continue
        try:
            result = read_nav(file)
        except LogError as error:
            notes.append(f"{path.name}: a navigation file beside it cannot be used: {error}")
            continue
        if np.abs(result.times - time).min() < _REACH_S:
            found = found.with_more(result)
            used.append(file.name)
            notes += [one.sentence(file) for one in result.damage]
    if not used:
        return None, [*notes, f"{path.name}: {NONE}"]
    notes.append(f"{path.name}: the satellite positions are from {' and '.join(used)}.")
    if found.odd:
        notes.append(f"{path.name}: ephemerides that contradict the others were left out, of {', '.join(found.odd)}.")
    if found.klobuchar is None:
        notes.append(
            f"{path.name}: there are no coefficients for the ionosphere in them; its delay stays in the ranges."
        )
    return found, notes


def _is_nav(file: Path) -> bool:
    with file.open("rb") as opened:
        return looks_rinex("NG", opened.read(96))
