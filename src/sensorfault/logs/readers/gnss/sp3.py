"""SP3 files: where satellites were and what their clocks showed, computed afterwards.

Source: S. Hilla, The Extended Standard Product 3 Orbit Format (SP3-d), 2016.
"""

from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from sensorfault.logs.readers.format import Format, one_table, remembering
from sensorfault.logs.readers.gnss.leader import observations_beside
from sensorfault.logs.readers.gnss.observed import Observed
from sensorfault.logs.readers.gnss.rinex import calendar_s, lines_of
from sensorfault.logs.readers.gps_time import GPS_EPOCH_S
from sensorfault.logs.readers.source import Damage, Source
from sensorfault.logs.table import LogError

_NO_CLOCK = 999_999.0  # [µs]; what is as large or larger stands for none


class Orbits(NamedTuple):
    """T epochs of S satellites, NaN where none is told."""

    time: Float[np.ndarray, " T"]  # [s of GPS time]
    satellites: tuple[str, ...]
    position: Float[np.ndarray, "T S 3"]  # ECEF, of the centre of mass [m]
    clock: Float[np.ndarray, "T S"]  # ahead, without the periodic relativistic part [s]
    damage: tuple[Damage, ...] = ()


def read_sp3(path: Path) -> Source:
    """Each satellite's place and clock as columns `G07.x_m`, `G07.y_m`, `G07.z_m`, `G07.clock_s`, on Unix time.

    Raises:
        LogError: no SP3 file, or no positions in it.
    """
    orbits = read_orbits(path)
    value = {f"{axis}_m": orbits.position[..., k] for k, axis in enumerate("xyz")}
    return Observed(orbits.time, orbits.satellites, {**value, "clock_s": orbits.clock}).table(
        path, damage=orbits.damage
    )


def read_orbits(path: Path) -> Orbits:
    """The same as arrays.

    Raises:
        LogError: no SP3 file, or no positions in it.
    """
    lines = lines_of(path)
    if not lines or not looks_sp3(lines[0].encode()):
        raise LogError(f"{path}: this is no SP3 file by its first line (#c or #d, and P or V); download it again.")
    times: list[float] = []
    rows: list[dict[str, list[float]]] = []
    damage = []
    for number, line in enumerate(lines, 1):
        try:
            if line.startswith("* "):
                times.append(calendar_s(line[2:].split()) - GPS_EPOCH_S)
                rows.append({})
            elif line.startswith("P") and rows:
                rows[-1][line[1:4].replace(" ", "0")] = [float(line[4 + 14 * i : 18 + 14 * i]) for i in range(4)]
        except (ValueError, IndexError):
            damage.append(Damage("a line cannot be read", f"line {number}", "it was left out"))
            if line.startswith("* "):
                break
    if len(rows) > len(times):
        rows.pop()
    if lines[-1].strip() != "EOF":
        damage.append(Damage("the file breaks off", f"line {len(lines)}"))
    names = tuple(sorted({name for row in rows for name in row}))
    if not names:
        raise LogError(f"{path}: the SP3 file holds no positions; download it again.")
    empty = [np.nan] * 4
    result = np.array([[row.get(name, empty) for name in names] for row in rows])
    result[(result[..., :3] == 0).all(axis=-1)] = np.nan
    clock = np.where(np.abs(result[..., 3]) < _NO_CLOCK, result[..., 3] * 1e-6, np.nan)
    return Orbits(np.array(times), names, result[..., :3] * 1e3, clock, tuple(damage))


def looks_sp3(head: bytes) -> bool:
    """Whether a file that begins so is one."""
    return head[:2] in (b"#a", b"#b", b"#c", b"#d") and head[2:3] in (b"P", b"V")


FORMAT = Format("SP3 orbits", ("*.sp3",), remembering(one_table(read_sp3)), leader=observations_beside)
