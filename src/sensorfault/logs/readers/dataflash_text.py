"""ArduPilot DataFlash logs as text (`.log`): a line a message, its name first, and FMT lines that name the cells."""

from collections import defaultdict
from pathlib import Path

import polars as pl

from sensorfault.logs.readers.dataflash import CLOCKS, INSTANCE
from sensorfault.logs.readers.source import Ask, Damage, Source, Tables, told
from sensorfault.logs.readers.telling import TellingFile
from sensorfault.logs.table import LogError


def looks_dataflash_text(head: bytes) -> bool:
    """Whether a file begins with the descriptions of its messages."""
    return any(line.startswith(b"FMT,") for line in head.splitlines())


def read_dataflash_text(path: Path, ask: Ask) -> Tables:
    """Every kind of message that has a time, on the autopilot's clock. `IMU[1]` is the second of several IMUs.

    Raises:
        LogError: empty, no such text, or no message with a time in it.
    """
    names, rows, damage = _messages(path, ask)
    tables: Tables = {}
    for kind, cells in rows.items():
        clock = next(((name, unit) for name, unit in CLOCKS if name in names[kind]), None)
        if clock is not None and len(cells) > 1:
            tables |= _by_instance(path, kind, _frame(names[kind], cells), clock)
    if not tables:
        what = "no messages with a time in this DataFlash log" if names else "this is no DataFlash log (no FMT line)"
        raise LogError(f"{path}: {what}; name a .log file of a whole flight.")
    return told({name: one for name, one in tables.items() if ask.wants(name)}, (), damage)


def _messages(path: Path, ask: Ask) -> tuple[dict[str, list[str]], dict[str, list[list[str]]], list[Damage]]:
    """Names of the cells of each kind of message, the cells, and what is no message."""
    names: dict[str, list[str]] = {}
    rows: dict[str, list[list[str]]] = defaultdict(list)
    odd, first_odd, number, line = 0, 0, 0, b""
    with TellingFile(path, ask.tell) as file:
        for number, line in enumerate(file, 1):
            kind, *cells = (cell.strip() for cell in line.decode("utf-8", "replace").split(","))
            if kind == "FMT" and _describes(cells, names):
                names[cells[2]] = cells[4:]
            elif kind in names and kind != "FMT" and len(cells) >= len(names[kind]) and line.endswith(b"\n"):
                rows[kind].append(cells[: len(names[kind])])
            elif line.strip() and (kind not in names or line.endswith(b"\n")):
                odd, first_odd = odd + 1, first_odd or number
    damage = []
    if odd:
        damage.append(Damage(f"{odd} lines are no messages, the first", f"line {first_odd}", "the others were read"))
    if line and not line.endswith(b"\n"):
        damage.append(Damage("the file breaks off", f"line {number}"))
    return names, rows, damage


def _describes(cells: list[str], names: dict[str, list[str]]) -> bool:
    """Whether an FMT line describes a kind of message, not otherwise than a line before."""
    own = cells[4:]
    return len(own) == len(set(own)) > 0 and names.get(cells[2], own) == own


def _frame(names: list[str], cells: list[list[str]]) -> pl.DataFrame:
    """The columns that hold numbers."""
    texts = pl.DataFrame(cells, schema=dict.fromkeys(names, pl.String), orient="row")
    numbers = texts.cast(pl.Float64, strict=False)
    return numbers.select(name for name in numbers.columns if numbers[name].null_count() < len(numbers) / 2)


def _by_instance(path: Path, kind: str, frame: pl.DataFrame, clock: tuple[str, str]) -> Tables:
    if clock[0] not in frame.columns:
        return {}
    if INSTANCE not in frame.columns:
        return {kind: Source(path, frame, *clock)}
    devices = frame.partition_by(INSTANCE, as_dict=True)
    return {
        f"{kind}[{device:.0f}]" if device else kind: Source(path, of_it, *clock)
        for (device,), of_it in devices.items()
        if device is not None and len(of_it) > 1
    }
