"""ArduPilot DataFlash logs (`.bin`): one table for each kind of message, found by pymavlink."""

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import polars as pl
from numpy.lib.stride_tricks import sliding_window_view

from sensorfault.logs.readers.covered import Covered
from sensorfault.logs.readers.format import Format, remembering
from sensorfault.logs.readers.handing import Handing
from sensorfault.logs.readers.lasting import usable
from sensorfault.logs.readers.native import native
from sensorfault.logs.readers.source import Ask, Damage, Source, Tables, joined, with_notes
from sensorfault.logs.table import LogError
from sensorfault.logs.units import known, spelled

if TYPE_CHECKING:
    from sensorfault.logs.readers.dataflash_load import Piece

HEAD = b"\xa3\x95"  # every message begins so
CLOCKS = (("TimeUS", "us"), ("T", "ms"), ("TimeMS", "ms"))  # an older GPS message has the autopilot's time in T
INSTANCE = "I"
_HEAD_BYTES = 3
_PADDING = 528  # a log is written in pages: what is left at the end of the last one is no damage
_PLAIN = {"b": "i1", "B": "u1", "h": "<i2", "H": "<u2", "i": "<i4", "I": "<u4", "q": "<i8", "Q": "<u8", "M": "u1",
          "g": "<f2", "f": "<f4", "d": "<f8", "c": "<i2", "C": "<u2", "e": "<i4", "E": "<u4", "L": "<i4",
          "n": "S4", "N": "S16", "Z": "S64", "a": "S64"}  # fmt: skip


def read_dataflash(path: Path, ask: Ask) -> Tables:
    """Every kind of message that has a time, on the autopilot's clock. `IMU[1]` is the second of several IMUs.

    Raises:
        LogError: empty, not a DataFlash log, or too few messages that can be read.
    """
    with path.open("rb") as file:
        head = file.read(2)
    if head != HEAD:
        what = "an empty file" if not head else "not a DataFlash log (it does not begin with A3 95)"
        raise LogError(f"{path}: this is {what}; name a .bin file as the autopilot wrote it.")
    from sensorfault.logs.readers.dataflash_load import BadDescription, pieces_of  # lazily: for pymavlink

    handing, covered = Handing(ask), Covered()
    tables: Tables = {}
    damage: list[Damage] = []
    odd: dict[str, None] = {}
    try:
        for piece in pieces_of(path):
            covered.take(*_spans(piece))
            odd |= dict.fromkeys(_odd(piece))
            tables = joined(tables, _tables(path, piece, ask))
            if handing.asked:
                handing.on(tables)
                tables = {}
            ask.tell(piece.end / path.stat().st_size)
    except BadDescription as bad:
        if not bad.at:
            raise LogError(f"{path}: the DataFlash log is damaged ({bad}); copy it from the autopilot again.") from None
        damage.append(Damage(f"the descriptions of its messages are damaged ({bad}), after", f"byte {bad.at}"))
    if not handing.asked:
        tables = usable(tables)
    tables = handing.rest(tables)
    if not tables and ask.tables is None:
        raise LogError(f"{path}: no messages with a time in this DataFlash log; name a log of a whole flight.")
    notes = [f"{path.name}: messages with contradictory descriptions left out: {', '.join(odd)}."] if odd else []
    return with_notes(tables, notes, [*covered.damage(), *(damage or _tail(path, covered.end))])


def _odd(piece: "Piece") -> list[str]:
    """Kinds of messages with a time that cannot be read."""
    forms = [piece.formats[number] for number, start in piece.starts.items() if len(start)]
    return [f"{form.name!r}" for form in forms if _clock(form) is not None and not _is_sound(form)]


def _clock(form: Any) -> tuple[str, str] | None:
    return next(((name, unit) for name, unit in CLOCKS if name in form.columns), None)


def _spans(piece: "Piece") -> tuple[np.ndarray, np.ndarray]:
    """Where in the file each message begins, and its bytes."""
    starts = [piece.at + start for start in piece.starts.values()]
    sizes = [np.full(len(start), piece.formats[number].len) for number, start in piece.starts.items()]
    return np.concatenate(starts), np.concatenate(sizes)


def _tables(path: Path, piece: "Piece", ask: Ask) -> Tables:
    """The messages of a piece that have a time, of the kinds that are asked for."""
    kinds = None if ask.tables is None else {name.partition("[")[0] for name in ask.tables}
    tables: Tables = {}
    for number, start in piece.starts.items():
        form = piece.formats[number]
        clock = _clock(form)
        if clock is not None and len(start) and (kinds is None or form.name in kinds) and _is_sound(form):
            messages = sliding_window_view(piece.content, form.len - _HEAD_BYTES)[start + _HEAD_BYTES]
            tables |= _by_instance(path, form, messages, clock)
    return {name: one for name, one in tables.items() if ask.wants(name)}


def _is_sound(form: Any) -> bool:
    """Whether a kind of message is described without contradiction, in words."""
    fits = np.dtype([(str(i), _PLAIN[c]) for i, c in enumerate(form.format)]).itemsize == form.len - _HEAD_BYTES
    words = all(name.isprintable() for name in (form.name, *form.columns))
    return fits and words and len(form.columns) == len(form.format) == len(set(form.columns) - {""})


def _by_instance(path: Path, form: Any, messages: np.ndarray, clock: tuple[str, str]) -> Tables:
    """One kind of message; of several devices one table each."""
    record = np.dtype([(name, _PLAIN[c]) for name, c in zip(form.columns, form.format, strict=True)])
    rows = np.ascontiguousarray(messages).view(record)[:, 0]
    which = form.instance_field or INSTANCE
    if which not in form.columns or rows[which].dtype.kind not in "iu":
        return {form.name: _table(path, form, rows, clock)}
    devices = {int(one): rows[rows[which] == one] for one in np.unique(rows[which])}
    return {
        f"{form.name}[{device}]" if device else form.name: _table(path, form, of_it, clock)
        for device, of_it in devices.items()
    }


def _table(path: Path, form: Any, rows: np.ndarray, clock: tuple[str, str]) -> Source:
    """The numbers of messages of one kind as columns."""
    columns, units = {}, {}
    for i, name in enumerate(form.columns):
        if rows[name].dtype.kind == "S":
            continue
        factor = form.msg_mults[i]  # exact by division: 1e2 and 1e7 are whole, 1e-2 and 1e-7 are none
        column = native(rows[name])
        columns[name] = pl.Series(name, column if factor is None else column / round(1 / factor), nan_to_null=False)
        unit = spelled(form.units[i]) if form.units else ""
        if unit and known(unit):
            units[name] = unit
    return Source(path, pl.DataFrame(columns), *clock, units=units)


def _tail(path: Path, end: int) -> list[Damage]:
    """Bytes behind the last message, unless they only fill the last page."""
    with path.open("rb") as file:
        file.seek(end)
        tail = file.read(_PADDING)
    if len(tail) < _PADDING and not tail.startswith(HEAD):
        return []
    return [Damage("the file ends with an incomplete message,", f"byte {end}")]


FORMAT = Format("ArduPilot DataFlash", ("*.bin",), remembering(read_dataflash), parts=True)
