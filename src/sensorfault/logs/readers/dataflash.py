"""ArduPilot DataFlash logs (`.bin`): one table for each kind of message, found by pymavlink."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl

from sensorfault.logs.readers.native import native
from sensorfault.logs.readers.quiet import quiet
from sensorfault.logs.readers.source import Ask, Damage, Source, Tables, told
from sensorfault.logs.table import LogError
from sensorfault.logs.units import known, spelled

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
        LogError: empty, not a DataFlash log, or hardly a message in it that can be read.
    """
    with path.open("rb") as file:
        head = file.read(2)
    if head != HEAD:
        what = "an empty file" if not head else "not a DataFlash log (it does not begin with A3 95)"
        raise LogError(f"{path}: this is {what}; name a .bin file as the autopilot wrote it.")
    formats, offsets = _index(path, ask)
    content = np.memmap(path, np.uint8, mode="r")
    spans: list[np.ndarray] = []
    tables: Tables = {}
    for number, form in formats.items():
        start = np.asarray(offsets[number], np.int64)
        start = start[start + form.len <= len(content)]
        spans.append(np.column_stack([start, np.full_like(start, form.len)]))
        clock = next(((name, unit) for name, unit in CLOCKS if name in form.columns), None)
        if clock is not None and len(start) > 1 and _is_whole(form):
            messages = content[start[:, None] + np.arange(_HEAD_BYTES, form.len)]
            tables |= _by_instance(path, form, messages, clock)
    if not tables:
        raise LogError(f"{path}: no messages with a time in this DataFlash log; name a log of a whole flight.")
    return told({name: one for name, one in tables.items() if ask.wants(name)}, (), _damage(content, spans))


def _index(path: Path, ask: Ask) -> tuple[Mapping[int, Any], list[Any]]:
    """What each kind of message is like, and where in the file its messages begin."""
    from pymavlink.DFReader import DFReader_binary  # lazily: only this format needs it

    with quiet():
        reader = DFReader_binary.__new__(DFReader_binary)
        try:
            reader.__init__(str(path), progress_callback=lambda percent: ask.tell(percent / 100))
        except Exception as error:  # a damaged log fails in as many ways as it can be damaged
            reader.filehandle.close()  # which it has opened first of all
            reason = (str(error).splitlines() or [type(error).__name__])[0].rstrip(".")
            raise LogError(
                f"{path}: the DataFlash log is damaged ({reason}); copy it from the autopilot again."
            ) from None
        formats, offsets = dict(reader.formats), reader.offsets
        reader.close()
    return formats, offsets


def _is_whole(form: Any) -> bool:
    """Whether the kind of message is described without contradiction."""
    fits = np.dtype([(str(i), _PLAIN[c]) for i, c in enumerate(form.format)]).itemsize == form.len - _HEAD_BYTES
    return fits and len(form.columns) == len(form.format) == len(set(form.columns) - {""})


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
        if len(of_it) > 1
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


def _damage(content: np.ndarray, spans: list[np.ndarray]) -> list[Damage]:
    """Bytes that belong to no message, unless they only fill the last page."""
    span = np.concatenate(spans)
    span = span[np.argsort(span[:, 0])]
    end = np.concatenate([[0], span.sum(axis=1)])
    start = np.concatenate([span[:, 0], [len(content)]])
    lost = start - np.maximum.accumulate(end)
    tail = int(lost[-1])
    found = []
    if (lost[:-1] > 0).any():
        first = int(end[np.argmax(lost[:-1] > 0)])
        count = int(lost[:-1][lost[:-1] > 0].sum())
        found.append(Damage(f"{count} bytes belong to no message, the first", f"byte {first}", "the others were read"))
    at = len(content) - tail
    if tail >= _PADDING or content[at : at + 2].tobytes() == HEAD:
        found.append(Damage("the file ends in what is no whole message,", f"byte {at}"))
    return found
