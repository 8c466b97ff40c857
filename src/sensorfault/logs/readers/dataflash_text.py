"""ArduPilot DataFlash logs as text (`.log`): a line a message, its name first, and FMT lines that name the cells."""

from collections import defaultdict
from functools import partial
from pathlib import Path

import polars as pl

from sensorfault.logs.readers.dataflash import CLOCKS, INSTANCE
from sensorfault.logs.readers.dataflash_dated import PLACE, dated
from sensorfault.logs.readers.format import Format, remembering
from sensorfault.logs.readers.handing import Handing
from sensorfault.logs.readers.lasting import usable
from sensorfault.logs.readers.source import PART, Ask, Damage, Source, Tables, with_notes
from sensorfault.logs.readers.telling import TellingFile
from sensorfault.logs.table import LogError

_LONGEST = 1 << 20  # bytes of a line: what is longer is none, and must not fill the memory
_UNITS, _DEVICE = 2, "#"  # the cell of FMTU with a letter for each cell's unit; the letter of a device's number
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
        tables = usable(tables)
    tables = handing.rest(tables)
    if not tables and ask.tables is None:
        named = "no messages with a time in this DataFlash log"
        if messages.names:
            raise LogError(f"{path}: {named}; name a .log file of a whole flight.")
        raise LogError(
            f"{path}: this .log is none of a flight (no FMT line), of a receiver (no NMEA sentence) or of a CAN bus "
            "(candump); give one of these, or a table as .csv."
        )
    return with_notes(tables, messages.notes(), messages.damage())


class _Messages:
    """Collects lines. `names`: of the cells of each kind of message. `cells`: how many are collected."""

    def __init__(self, path: Path, ask: Ask) -> None:
        self.names: dict[str, list[str]] = {}
        self.cells = 0
        self._path, self._ask = path, ask
        self._kinds = None if ask.tables is None else {name.partition("[")[0] for name in ask.tables}
        self._rows: dict[str, list[list[str]]] = defaultdict(list)
        self._lines: dict[str, list[int]] = defaultdict(list)
        self._dated: dict[str, None] = {}
        self._numbers: dict[str, set[str]] = defaultdict(set)  # names of the cells that have held numbers
        self._numbered: dict[str, str] = {}  # kinds by their number
        self._instance: dict[str, str] = {}  # the name of the cell that says which of several devices
        self._odd, self._first_odd, self._last, self._cut = 0, 0, 0, False

    def take(self, number: int, line: bytes) -> None:
        """A line of the file."""
        kind, *cells = (cell.strip() for cell in line.decode("utf-8", "replace").split(","))
        self._last, self._cut = number, not line.endswith(b"\n")
        if kind == "FMT" and _describes(cells, self.names):
            self.names[cells[2]] = cells[4:]
            self._numbered[cells[0]] = cells[2]
        elif kind == "FMTU" and len(cells) > _UNITS and cells[1] in self._numbered:
            named = self._numbered[cells[1]]
            self._instance[named] = dict(zip(cells[_UNITS], self.names[named], strict=False)).get(_DEVICE, INSTANCE)
        elif kind in self.names and kind != "FMT" and len(cells) >= len(self.names[kind]) and not self._cut:
            if self._kinds is None or kind in self._kinds:
                self._rows[kind].append(cells[: len(self.names[kind])])
                self._lines[kind].append(number)
                self.cells += len(self.names[kind])
        elif line.strip() and (kind not in self.names or not self._cut):
            self._odd, self._first_odd = self._odd + 1, self._first_odd or number

    def tables(self) -> Tables:
        """The tables of what has been gathered, which is then forgotten."""
        tables: Tables = {}
        frames = {kind: self._frame(kind, cells) for kind, cells in self._rows.items() if cells}
        clocks = {
            kind: next((one for one in CLOCKS if one[0] in frame.columns), None) for kind, frame in frames.items()
        }
        timed = {kind: clock for kind, clock in clocks.items() if clock is not None}
        most = max(timed, key=lambda kind: len(frames[kind]), default=None)
        for kind, frame in frames.items():
            clock = clocks[kind]
            if clock is None and most is not None:
                clock = PLACE, timed[most][1]
                frame = dated(frame, self._lines[kind], frames[most][timed[most][0]], self._lines[most])
                self._dated |= {kind: None} if len(frame) > 1 else {}
            if clock is not None:
                instance = self._instance.get(kind, INSTANCE)
                tables |= _by_instance(self._path, kind, frame, clock, instance)
        self._rows.clear()
        self._lines.clear()
        self.cells = 0
        return {name: one for name, one in tables.items() if self._ask.wants(name)}

    def _frame(self, kind: str, cells: list[list[str]]) -> pl.DataFrame:
        """The columns that hold numbers."""
        texts = pl.DataFrame(cells, schema=dict.fromkeys(self.names[kind], pl.String), orient="row")
        numbers = texts.cast(pl.Float64, strict=False)
        few = len(numbers) / 2
        self._numbers[kind] |= {name for name in numbers.columns if numbers[name].null_count() < few}
        return numbers.select(name for name in numbers.columns if name in self._numbers[kind])

    def notes(self) -> list[str]:
        """What has no time of its own."""
        if not self._dated:
            return []
        kinds = ", ".join(self._dated)
        return [f"{self._path.name}: messages without a time are dated by their place among the others: {kinds}."]

    def damage(self) -> list[Damage]:
        """What was no message."""
        damage = []
        if self._odd:
            what = f"{self._odd} lines are not messages, the first"
            damage.append(Damage(what, f"line {self._first_odd}", "the others were read"))
        if self._cut:
            damage.append(Damage("the file breaks off", f"line {self._last}"))
        return damage


def _describes(cells: list[str], names: dict[str, list[str]]) -> bool:
    """Whether an FMT line describes a kind of message, not otherwise than a line before."""
    own = cells[4:]
    return len(own) == len(set(own)) > 0 and names.get(cells[2], own) == own


def _by_instance(path: Path, kind: str, frame: pl.DataFrame, clock: tuple[str, str], instance: str) -> Tables:
    if clock[0] not in frame.columns:
        return {}
    if instance not in frame.columns:
        return {kind: Source(path, frame, *clock)}
    devices = frame.partition_by(instance, as_dict=True)
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
    priority=3,
)
