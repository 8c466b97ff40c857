"""PX4's logs (`.ulg`): one table for each topic, by pyulog."""

import struct
from errno import EINVAL
from io import BufferedReader
from pathlib import Path
from typing import TYPE_CHECKING, Any

import polars as pl

from sensorfault.logs.phrase import times
from sensorfault.logs.readers.native import native_fields
from sensorfault.logs.readers.quiet import quiet
from sensorfault.logs.readers.source import Ask, Damage, Source, Tables, told
from sensorfault.logs.readers.telling import open_telling
from sensorfault.logs.table import LogError

if TYPE_CHECKING:
    from pyulog import ULog

_MAGIC = b"ULog\x01\x12\x35"
_TIME = "timestamp"


def read_ulog(path: Path, ask: Ask) -> Tables:
    """Every topic, on the autopilot's clock [us]. `sensor_baro[1]` is the second of several instances of a topic.

    Raises:
        LogError: empty, not a ULog file, or no topic in it that can be read.
    """
    with path.open("rb") as file:
        head = file.read(len(_MAGIC))
    if head != _MAGIC:
        what = "an empty file" if not head else "no ULog (it does not begin with 'ULog')"
        raise LogError(f"{path}: this is {what}; name a .ulg file as PX4 wrote it.")
    names = None if ask.tables is None else sorted({name.partition("[")[0] for name in ask.tables})
    with open_telling(path, ask.tell) as opened, quiet():
        log, broken_at, cut = _load(path, opened, names)
    damage = []
    if broken_at is not None:
        damage.append(Damage("messages that cannot be read, the first", f"byte {broken_at}", "the others were read"))
    elif cut:
        damage.append(Damage("the file breaks off inside a message", f"byte {path.stat().st_size}"))
    tables = {_called(one): _table(path, one) for one in log.data_list if _TIME in one.data}
    tables = {name: table for name, table in tables.items() if ask.wants(name)}
    if not tables and names is None:
        where = f" (damaged at {damage[0].where})" if damage else ""
        raise LogError(f"{path}: no topic with a time in this log{where}; name a log of a whole flight.")
    return told(tables, _dropouts(path, log), damage)


def _load(path: Path, opened: BufferedReader, names: list[str] | None) -> "tuple[ULog, int | None, bool]":
    """The log, how far into the file its first broken message was noticed, and whether its last one is cut."""
    from pyulog import ULog  # lazily: only this format needs it

    class Located(ULog):  # type: ignore[misc]
        """pyulog says that a file is corrupt, not where."""

        broken_at: int | None = None

        @property
        def _file_corrupt(self) -> bool:
            return self.broken_at is not None

        @_file_corrupt.setter
        def _file_corrupt(self, corrupt: bool) -> None:
            if corrupt and self.broken_at is None:
                self.broken_at = opened.tell()

        class _MessageHeader(ULog._MessageHeader):  # type: ignore[misc]
            def initialize(self, data: bytes) -> None:
                try:
                    self.msg_size, self.msg_type = unpack(data)
                except struct.error:
                    left.append(len(data))
                    raise

    unpack = struct.Struct("<HB").unpack
    left: list[int] = []  # bytes of a header that the file ended in; nothing: it ended in what comes behind one
    try:
        log = Located(opened, names)
    except Exception as error:  # a damaged log fails in as many ways as it can be damaged
        if isinstance(error, OSError) and error.errno != EINVAL:  # a seek to before the file is the content's fault
            raise
        reason = "it ends inside its definitions" if isinstance(error, OSError) else _first_line(error)
        raise LogError(f"{path}: the ULog is damaged ({reason}); copy it from the autopilot again.") from None
    return log, log.broken_at, left[-1:] != [0]


def _first_line(error: Exception) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0].rstrip(".")


def _dropouts(path: Path, log: "ULog") -> list[str]:
    """What the autopilot itself says that it could not write down."""
    lost_s = sum(one.duration for one in log.dropouts) / 1e3
    if not log.dropouts:
        return []
    return [f"{path.name}: the autopilot could not write {times(len(log.dropouts))}, {lost_s:.3g} s in all."]


def _called(topic: Any) -> str:
    return f"{topic.name}[{topic.multi_id}]" if topic.multi_id else str(topic.name)


def _table(path: Path, topic: Any) -> Source:
    """One topic's fields as columns; padding is none."""
    fields = {name: field for name, field in topic.data.items() if not name.startswith("_padding")}
    columns = native_fields(fields)
    frame = pl.DataFrame({name: pl.Series(name, column, nan_to_null=False) for name, column in columns.items()})
    return Source(path, frame, _TIME, "us")
