"""Recordings of a CAN bus (`.blf`, `.asc`), by python-can, decoded by the `.dbc` files beside them, by cantools."""

from collections import Counter, defaultdict
from pathlib import Path
from typing import IO, Any

import numpy as np
import polars as pl

from sensorfault.logs.phrase import counted
from sensorfault.logs.readers.apart import reason
from sensorfault.logs.readers.extra import extra
from sensorfault.logs.readers.quiet import quiet
from sensorfault.logs.readers.source import Ask, Damage, Source, Tables, told
from sensorfault.logs.table import LogError
from sensorfault.logs.units import known, spelled

TIME = "time"
Rows = dict[str, list[dict[str, float]]]


def read_can(path: Path, ask: Ask) -> Tables:
    """A table for each message that the databases describe, by its name. What cannot be decoded is counted and said.

    Raises:
        LogError: no recording, no database beside it, or nothing in it that they describe; or no library for it.
    """
    with extra(path, "bus"), quiet():
        import can  # lazily: only this format needs them
        import cantools

        database = cantools.database.Database(strict=False)
        beside = sorted(path.parent.glob("*.dbc"))
        if not beside:
            raise LogError(f"{path}: no .dbc file lies beside it; put one there that says what its messages mean.")
        for file in beside:
            try:
                database.add_dbc_file(str(file))
            except Exception as error:
                raise LogError(f"{file}: this database cannot be read ({reason(error)}); export it again.") from None
        rows, unknown, damage = _messages(path, can, database, ask)
    tables = {name: _table(path, each, database.get_message_by_name(name)) for name, each in rows.items()}
    found = {name: table for name, table in tables.items() if table is not None}
    if not found:
        named = ", ".join(file.name for file in beside)
        raise LogError(f"{path}: no message in it is one of {named}; put the database of this vehicle beside it.")
    listed = ", ".join(f"0x{one:X}" for one in list(unknown)[:6])
    left = [f"{path.name}: {counted(sum(unknown.values()), 'frame')} of unknown messages left out, of {listed}."]
    return told(found, left if unknown else (), damage)


def _messages(path: Path, can: Any, database: Any, ask: Ask) -> tuple[Rows, Counter[int], list[Damage]]:
    """The signals of every frame that is described; how many of each other identifier; where it breaks off."""
    rows: Rows = defaultdict(list)
    unknown: Counter[int] = Counter()
    damage: list[Damage] = []
    spoilt, read, last = 0, 0, 0.0
    try:
        with _opened(path) as file:
            for frame in (can.ASCReader if path.suffix.lower() == ".asc" else can.BLFReader)(file):
                if frame.is_error_frame or frame.is_remote_frame:
                    continue
                read, last = read + 1, frame.timestamp
                try:
                    message = database.get_message_by_frame_id(frame.arbitration_id)
                except KeyError:
                    unknown[frame.arbitration_id] += 1
                    continue
                try:
                    told_by = message.decode(bytes(frame.data), decode_choices=False, allow_truncated=True)
                except Exception:
                    spoilt += 1
                    continue
                rows[message.name].append({TIME: frame.timestamp, **_numbers(told_by)})
    except Exception as error:  # a damaged recording fails in as many ways as it can be damaged
        if isinstance(error, OSError) and error.errno is not None:
            raise  # no fault of the content
        if not read:
            raise LogError(f"{path}: not a recording of a CAN bus ({reason(error)}); export it again.") from None
        damage.append(Damage(f"the recording breaks off ({reason(error)})", f"frame {read}, {last:.3f} s"))
    if spoilt:
        damage.append(Damage(f"{counted(spoilt, 'frame')} cannot be decoded", "other places", "they were left out"))
    return rows, unknown, damage


def _opened(path: Path) -> IO[Any]:
    """The file; readers that fail at its head would leave it open."""
    return path.open(encoding="utf-8", errors="replace") if path.suffix.lower() == ".asc" else path.open("rb")


def _numbers(told_by: Any) -> dict[str, float]:
    return {name: float(value) for name, value in told_by.items() if isinstance(value, int | float)}


def _table(path: Path, rows: list[dict[str, float]], message: Any) -> Source | None:
    """One message's signals as columns."""
    names = list(dict.fromkeys(name for row in rows for name in row))
    if len(rows) < 2 or len(names) < 2:
        return None
    columns = {name: np.array([row.get(name, np.nan) for row in rows]) for name in names}
    unit = {signal.name: str(signal.unit or "") for signal in message.signals}
    units = {name: spelled(unit[name]) for name in names if name in unit and unit[name] and known(unit[name])}
    return Source(path, pl.DataFrame(columns), TIME, "s", units=units)
