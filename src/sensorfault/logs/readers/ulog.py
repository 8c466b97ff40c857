"""PX4's logs (`.ulg`): one table for each topic, by pyulog."""

from errno import EINVAL
from pathlib import Path
from typing import TYPE_CHECKING, Any

import polars as pl

from sensorfault.logs.phrase import times
from sensorfault.logs.readers.format import Format, remembering
from sensorfault.logs.readers.handing import Handing
from sensorfault.logs.readers.native import native_fields
from sensorfault.logs.readers.quiet import quiet
from sensorfault.logs.readers.source import Ask, Damage, Source, Tables, joined, with_notes
from sensorfault.logs.table import LogError

if TYPE_CHECKING:
    from sensorfault.logs.readers.ulog_load import Loaded

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
    handing = Handing(ask)
    log = _load(path, ask, handing)
    damage = []
    if log.broken_at is not None:
        where = f"byte {log.broken_at}"
        damage.append(Damage("messages that cannot be read, the first", where, "the others were read"))
    elif log.left != 0:
        damage.append(Damage("the file breaks off inside a message", f"byte {path.stat().st_size}"))
    tables = handing.rest(_tables(path, ask, log.data_list))
    if not tables and ask.tables is None:
        where = f" (damaged at {damage[0].where})" if damage else ""
        raise LogError(f"{path}: no topic with a time in this log{where}; name a log of a whole flight.")
    return with_notes(tables, _dropouts(path, log), damage)


def _load(path: Path, ask: Ask, handing: Handing) -> "Loaded":
    """The log, or the last part of it once the others have been handed on."""
    from sensorfault.logs.readers.ulog_load import Loaded  # lazily: only this format needs pyulog

    failed: list[Exception] = []

    def take(topics: list[Any]) -> None:
        try:
            handing.on(_tables(path, ask, topics))
        except Exception as error:  # no fault of this file's
            failed.append(error)
            raise

    names = None if ask.tables is None else sorted({name.partition("[")[0] for name in ask.tables})
    try:
        with quiet() as aloud:
            return Loaded(path, names, aloud(ask.tell), aloud(take) if handing.asked else None)
    except Exception as error:  # a damaged log fails in as many ways as it can be damaged
        if failed or (isinstance(error, OSError) and error.errno != EINVAL):  # a seek to before the file: its content
            raise
        reason = "it ends inside its definitions" if isinstance(error, OSError) else _first_line(error)
        raise LogError(f"{path}: the ULog is damaged ({reason}); copy it from the autopilot again.") from None


def _first_line(error: Exception) -> str:
    return (str(error).splitlines() or [type(error).__name__])[0].rstrip(".")


def _dropouts(path: Path, log: "Loaded") -> list[str]:
    """What the autopilot itself says that it could not write down."""
    if not log.lost:
        return []
    return [f"{path.name}: the autopilot could not write {times(log.lost)}, {log.lost_s:.3g} s in all."]


def _tables(path: Path, ask: Ask, topics: list[Any]) -> Tables:
    """The tables that are asked for; a topic that was announced twice is one."""
    tables: Tables = {}
    for topic in topics:
        name = _called(topic)
        if _TIME in topic.data and ask.wants(name):
            tables = joined(tables, {name: _table(path, topic)})
    return tables


def _called(topic: Any) -> str:
    return f"{topic.name}[{topic.multi_id}]" if topic.multi_id else str(topic.name)


def _table(path: Path, topic: Any) -> Source:
    """One topic's fields as columns; padding is none."""
    fields = {name: field for name, field in topic.data.items() if not name.startswith("_padding")}
    columns = native_fields(fields)
    frame = pl.DataFrame({name: pl.Series(name, column, nan_to_null=False) for name, column in columns.items()})
    return Source(path, frame, _TIME, "us")


FORMAT = Format("PX4 ULog", ("*.ulg", "*.ulog"), remembering(read_ulog), parts=True)
