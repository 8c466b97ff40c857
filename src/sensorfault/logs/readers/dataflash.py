"""ArduPilot DataFlash logs (`.bin`): one table for each kind of message, by pymavlink."""

import os
from collections import defaultdict
from collections.abc import Iterator
from contextlib import closing, contextmanager, redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from typing import Any

import polars as pl

from sensorfault.logs.readers.source import Ask, Source, Tables, told
from sensorfault.logs.table import LogError

_HEAD = b"\xa3\x95"  # every message begins so
_CLOCKS = (("TimeUS", "us"), ("T", "ms"), ("TimeMS", "ms"))  # an older GPS message has the autopilot's time in T
_INSTANCE = "I"
_FULL = 0.9  # of the bytes of a whole log belong to messages


def read_dataflash(path: Path, ask: Ask) -> Tables:
    """Every kind of message that has a time, on the autopilot's clock. `IMU[1]` is the second of several IMUs.

    Raises:
        LogError: empty, not a DataFlash log, or hardly a message in it that can be read.
    """
    size = path.stat().st_size
    with path.open("rb") as file:
        head = file.read(2)
    if head != _HEAD:
        what = "an empty file" if not head else "not a DataFlash log (it does not begin with A3 95)"
        raise LogError(f"{path}: this is {what}; name a .bin file as the autopilot wrote it.")
    rows, read = _messages(path)
    tables = {name: table for name, of_it in rows.items() if (table := _table(path, of_it)) is not None}
    if not tables:
        raise LogError(f"{path}: no messages with a time in this DataFlash log; name a log of a whole flight.")
    if read < _FULL * size:
        note = f"{path.name}: only {read / size:.0%} of its bytes are messages that can be read; the rest was left out."
        tables = told(tables, (note,))
    return tables


def _messages(path: Path) -> tuple[dict[str, list[dict[str, Any]]], int]:
    """The fields of every message that can be read, by its kind, and how many bytes they were."""
    from pymavlink.DFReader import DFReader_binary  # lazily: only this format needs it

    rows: dict[str, list[dict[str, Any]]] = defaultdict(list)
    read = 0
    with _silent():
        try:
            with closing(DFReader_binary(str(path))) as reader:
                while (message := reader.recv_msg()) is not None:
                    fields = message.to_dict()
                    name, instance = fields.pop("mavpackettype"), fields.get(_INSTANCE, 0)
                    rows[f"{name}[{instance}]" if instance else name].append(fields)
                    read += message.fmt.len
        except Exception as error:  # a damaged log fails in as many ways as it can be damaged
            reason = (str(error).splitlines() or [type(error).__name__])[0].rstrip(".")
            raise LogError(
                f"{path}: the DataFlash log is damaged ({reason}); copy it from the autopilot again."
            ) from None
    return rows, read


@contextmanager
def _silent() -> Iterator[None]:
    """What pymavlink remarks, in Python and below, goes nowhere: what is wrong is told in one sentence."""
    kept = [os.dup(stream) for stream in (1, 2)]
    with open(os.devnull, "w") as nowhere, redirect_stdout(StringIO()), redirect_stderr(StringIO()):
        try:
            for stream in (1, 2):
                os.dup2(nowhere.fileno(), stream)
            yield
        finally:
            for stream, own in zip((1, 2), kept, strict=True):
                os.dup2(own, stream)
                os.close(own)


def _table(path: Path, messages: list[dict[str, Any]]) -> Source | None:
    """The fields of one kind of message as columns."""
    clock = next(((name, unit) for name, unit in _CLOCKS if name in messages[0]), None)
    if clock is None or len(messages) < 2:
        return None
    names = [name for name, cell in messages[0].items() if isinstance(cell, int | float)]
    frame = pl.DataFrame({name: [float(one[name]) for one in messages] for name in names})
    return Source(path, frame, *clock)
