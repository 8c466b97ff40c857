"""ArduPilot DataFlash logs as text (`.log`): a line a message, its name first, and FMT lines that name the cells."""

from collections import defaultdict
from functools import partial
from pathlib import Path

import polars as pl

from sensorfault.logs.readers.dataflash import CLOCKS, INSTANCE
from sensorfault.logs.readers.format import Format, remembering
from sensorfault.logs.readers.handing import Handing
from sensorfault.logs.readers.source import PART, Ask, Damage, Source, Tables, with_notes
from sensorfault.logs.readers.telling import TellingFile
from sensorfault.logs.table import LogError

_LONGEST = 1 << 20  # bytes of a line: what is longer is none, and must not fill the memory
PART_CELLS = PART // 8  # a cell is a string of sixty bytes until it is a number


def looks_dataflash_text(head: bytes) -> bool:
    """Whether a file begins with the descriptions of its messages."""
    return any(line.startswith(b"FMT,") for line in head.splitlines())


def read_dataflash_text(path: Path, ask: Ask) -> Tables:
    """Every kind of message that has a time, on the autopilot's clock. `IMU[1]` is the second of several IMUs.

    Raises:
        LogError: empty, no such text, or no message with a time in it.
    """
    messages, handing = _Messages(path, ask), Handing(ask)
    with TellingFile(path, ask.tell) as file:
        for number, line in enumerate(iter(partial(file.readline, _LONGEST), b""), 1):
            messages.take(number, line)
            if handing.asked and messages.cells >= PART_CELLS:
                handing.on(messages.tables())
    tables = messages.tables()
    if not handing.asked:
        tables = {name: one for name, one in tables.items() if len(one.frame) > 1}
    tables = handing.rest(tables)
    if not tables and ask.tables is None:
        named = "no messages with a time in this DataFlash log"
        what = named if messages.names else "this is no DataFlash log (no FMT line)"
        raise LogError(f"{path}: {what}; name a .log file of a whole flight.")
    return with_notes(tables, (), messages.damage())


class _Messages:
    """Gathers lines. `names`: of the cells of each kind of message. `cells`: how many are gathered."""

    def __init__(self, path: Path, ask: Ask) -> None:
        self.names: dict[str, list[str]] = {}
        self.cells = 0
        self._path, self._ask = path, ask
        self._kinds = None if ask.tables is None else {name.partition("[")[0] for name in ask.tables}
        self._rows: dict[str, list[list[str]]] = defaultdict(list)
        self._numbers: dict[str, set[str]] = defaultdict(set)  # names of the cells that have held numbers
        self._odd, self._first_odd, self._last, self._cut = 0, 0, 0, False

    def take(self, number: int, line: bytes) -> None:
        """A line of the file."""
        kind, *cells = (cell.strip() for cell in line.decode("utf-8", "replace").split(","))
        self._last, self._cut = number, not line.endswith(b"\n")
        if kind == "FMT" and _describes(cells, self.names):
            self.names[cells[2]] = cells[4:]
        elif kind in self.names and kind != "FMT" and len(cells) >= len(self.names[kind]) and not self._cut:
            if self._kinds is None or kind in self._kinds:
                self._rows[kind].append(cells[: len(self.names[kind])])
                self.cells += len(self.names[kind])
        elif line.strip() and (kind not in self.names or not self._cut):
            self._odd, self._first_odd = self._odd + 1, self._first_odd or number

    def tables(self) -> Tables:
        """The tables of what has been gathered, which is then forgotten."""
        tables: Tables = {}
        for kind, cells in self._rows.items():
            clock = next(((name, unit) for name, unit in CLOCKS if name in self.names[kind]), None)
            if clock is not None and cells:
                tables |= _by_instance(self._path, kind, self._frame(kind, cells), clock)
        self._rows.clear()
        self.cells = 0
        return {name: one for name, one in tables.items() if self._ask.wants(name)}

    def _frame(self, kind: str, cells: list[list[str]]) -> pl.DataFrame:
        """The columns that hold numbers."""
        texts = pl.DataFrame(cells, schema=dict.fromkeys(self.names[kind], pl.String), orient="row")
        numbers = texts.cast(pl.Float64, strict=False)
        few = len(numbers) / 2
        self._numbers[kind] |= {name for name in numbers.columns if numbers[name].null_count() < few}
        return numbers.select(name for name in numbers.columns if name in self._numbers[kind])

    def damage(self) -> list[Damage]:
        """What was no message."""
        damage = []
        if self._odd:
            what = f"{self._odd} lines are no messages, the first"
            damage.append(Damage(what, f"line {self._first_odd}", "the others were read"))
        if self._cut:
            damage.append(Damage("the file breaks off", f"line {self._last}"))
        return damage


def _describes(cells: list[str], names: dict[str, list[str]]) -> bool:
    """Whether an FMT line describes a kind of message, not otherwise than a line before."""
    own = cells[4:]
    return len(own) == len(set(own)) > 0 and names.get(cells[2], own) == own


def _by_instance(path: Path, kind: str, frame: pl.DataFrame, clock: tuple[str, str]) -> Tables:
    if clock[0] not in frame.columns:
        return {}
    if INSTANCE not in frame.columns:
        return {kind: Source(path, frame, *clock)}
    devices = frame.partition_by(INSTANCE, as_dict=True)
    return {
        f"{kind}[{device:.0f}]" if device else kind: Source(path, of_it, *clock)
        for (device,), of_it in devices.items()
        if device is not None
    }


FORMAT = Format(
    "ArduPilot DataFlash text",
    ("*.log",),
    remembering(read_dataflash_text),
    looks_dataflash_text,
    parts=True,
    priority=1,
)
