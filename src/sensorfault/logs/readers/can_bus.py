"""Recordings of a CAN bus (`.blf`, `.asc`, `.trc`, candump's `.log`), by python-can.

The `.dbc` files beside them decode them, by cantools.
"""

import re
import warnings
from collections import Counter
from collections.abc import Callable, Iterator
from io import TextIOWrapper
from pathlib import Path
from typing import Any

from sensorfault.logs.phrase import counted
from sensorfault.logs.readers.can_rows import Rows
from sensorfault.logs.readers.format import Format, remembering
from sensorfault.logs.readers.handing import Handing
from sensorfault.logs.readers.quiet import quiet
from sensorfault.logs.readers.source import PART, Ask, Damage, Tables, with_notes
from sensorfault.logs.readers.subprocess_reader import reason
from sensorfault.logs.readers.telling import TellingFile, open_telling
from sensorfault.logs.table import LogError

_READERS = {".blf": "BLFReader", ".asc": "ASCReader", ".trc": "TRCReader", ".log": "CanutilsLogReader"}  # of python-can


def read_can(path: Path, ask: Ask) -> Tables:
    """A table for each message that the databases describe, by its name; a note counts what cannot be decoded.

    Raises:
        LogError: no recording, no database beside it, or nothing in it that they describe.
        ImportError: no library for it.
    """
    handing = Handing(ask)
    with warnings.catch_warnings(), quiet() as aloud:
        warnings.simplefilter("ignore")
        import can  # lazily: only this format needs them
        import cantools

        beside = sorted(path.parent.glob("*.dbc"))
        decoding = _Decoding(path, _database(path, beside, cantools), handing, aloud(handing.on))
        damage: list[Damage] = []
        for frame in _frames(path, can, aloud(ask.tell), damage):
            decoding.take(frame)
    tables = handing.rest(decoding.rows.tables(path, least=1 if handing.begun else 2))
    if not tables:
        named = ", ".join(file.name for file in beside)
        raise LogError(f"{path}: no message in it is one of {named}; put the database of this vehicle beside it.")
    return with_notes(tables, decoding.unknown_said(), (*damage, *decoding.damage()))


def _database(path: Path, beside: list[Path], cantools: Any) -> Any:
    """All of the databases as one."""
    if not beside:
        raise LogError(f"{path}: there is no .dbc file beside it; put one there that describes its messages.")
    database = cantools.database.Database(strict=False)
    for file in beside:
        try:
            database.add_dbc_file(str(file))
        except Exception as error:
            raise LogError(f"{file}: this database cannot be read ({reason(error)}); export it again.") from None
    return database


def _frames(path: Path, can: Any, tell: Callable[[float], None], damage: list[Damage]) -> Iterator[Any]:
    """The frames with data, to the end or where the recording breaks off, which is put to `damage`."""
    read, last = 0, 0.0
    try:
        with _opened(path, tell) as file:
            for frame in getattr(can, _READERS[path.suffix.lower()])(file):
                if not (frame.is_error_frame or frame.is_remote_frame):
                    read, last = read + 1, frame.timestamp
                    yield frame
    except Exception as error:  # a damaged recording fails in as many ways as it can be damaged
        if isinstance(error, OSError) and error.errno is not None:
            raise  # no fault of the content
        if not read:
            raise LogError(f"{path}: not a recording of a CAN bus ({reason(error)}); export it again.") from None
        damage.append(Damage(f"the recording breaks off ({reason(error)})", f"frame {read}, {last:.3f} s"))


def _opened(path: Path, tell: Callable[[float], None]) -> TextIOWrapper | TellingFile:
    """The file; readers that fail at its head would leave it open."""
    if path.suffix.lower() == ".blf":
        return TellingFile(path, tell)
    return TextIOWrapper(open_telling(path, tell), "utf-8", "replace")


def _group(number: int) -> int:
    """The parameter group of an identifier of 29 bits (SAE J1939-21): without priority, source and destination."""
    group = number >> 8 & 0x3FFFF
    return group if group >> 8 & 0xFF >= 0xF0 else group & 0x3FF00


class _Decoding:
    """Frames -> rows, and a count of bad frames. `hand_on`: is called with the tables when they reach PART numbers."""

    def __init__(self, path: Path, database: Any, handing: Handing, hand_on: Callable[[Tables], None]) -> None:
        self.path, self.database = path, database
        of_trucks = [one for one in database.messages if one.protocol == "j1939"]
        self._groups = {_group(one.frame_id): one for one in of_trucks}
        self.rows = Rows()
        self._hand_on = hand_on if handing.asked else None
        self._unknown: Counter[int] = Counter()
        self._spoilt = 0

    def take(self, frame: Any) -> None:
        message = self._message(frame)
        if message is None:
            self._unknown[frame.arbitration_id] += 1
            return
        try:
            signals = message.decode(bytes(frame.data), decode_choices=False, allow_truncated=True)
        except Exception:
            self._spoilt += 1
            return
        self.rows.take(message, frame.timestamp, signals)
        if self._hand_on is not None and self.rows.numbers >= PART:
            self._hand_on(self.rows.tables(self.path, least=1))
            self.rows = Rows()

    def _message(self, frame: Any) -> Any:
        """What describes a frame: by its number, or by what it carries where that is SAE J1939, from any source."""
        try:
            return self.database.get_message_by_frame_id(frame.arbitration_id)
        except KeyError:
            return self._groups.get(_group(frame.arbitration_id)) if frame.is_extended_id else None

    def unknown_said(self) -> list[str]:
        if not self._unknown:
            return []
        listed = ", ".join(f"0x{one:X}" for one in list(self._unknown)[:6])
        count = counted(sum(self._unknown.values()), "frame")
        return [f"{self.path.name}: {count} of unknown messages left out: {listed}."]

    def damage(self) -> list[Damage]:
        if not self._spoilt:
            return []
        return [Damage(f"{counted(self._spoilt, 'frame')} cannot be decoded", "other places", "they were left out")]


def looks_candump(head: bytes) -> bool:
    """Whether a file begins with frames as candump writes them: (time) bus id#data."""
    return re.match(rb"\(\d+\.\d+\)\s+\S+\s+[0-9A-Fa-f]+##?[0-9A-Fa-fR]*", head) is not None


FORMATS = (
    Format("CAN recording", ("*.blf", "*.asc", "*.trc"), remembering(read_can), parts=True),
    Format("candump", ("*.log",), remembering(read_can), looks_candump, parts=True, priority=2),
)
