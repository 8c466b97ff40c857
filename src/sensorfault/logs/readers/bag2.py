"""ROS 2 bags of SQLite files (`.db3`): one file, or all that its metadata.yaml lies beside."""

import re
import sqlite3
from contextlib import closing
from pathlib import Path
from typing import Any

from sensorfault.logs.readers.decoded import Recording
from sensorfault.logs.readers.format import Format, remembering
from sensorfault.logs.readers.ros_types import decoder
from sensorfault.logs.readers.source import Ask, Damage, Tables
from sensorfault.logs.table import LogError

_MAGIC = b"SQLite format 3\x00"
_ZSTD = b"\x28\xb5\x2f\xfd"  # a message that was compressed by itself begins so
_TELL_EVERY = 10_000
_PART = re.compile(r"_\d+$")


def read_bag2(path: Path, ask: Ask) -> Tables:
    """Every topic that holds numbers.

    Raises:
        LogError: empty, no database of a ROS 2 bag, or no topic with numbers in it.
    """
    recording = Recording(path, ask)
    for part in parts_of(path):
        _part(part, recording, ask)
    return recording.tables()


def first_part(path: Path) -> Path:
    """The file that stands for all parts of a bag."""
    return min([path, *parts_of(path, every=True)])


def parts_of(path: Path, every: bool = False) -> list[Path]:
    """The parts of a bag in order, if the file is the first of them or `every` part is asked for; else the file."""
    if not (path.parent / "metadata.yaml").is_file() or not _PART.search(path.stem):
        return [path]
    stem = _PART.sub("", path.stem)
    same = (one for one in path.parent.glob(f"*{path.suffix}") if _PART.sub("", one.stem) == stem != one.stem)
    parts = sorted(same, key=lambda one: int(one.stem.rpartition("_")[2]))
    return parts if every or parts[:1] == [path] else [path]


def _part(path: Path, recording: Recording, ask: Ask) -> None:
    with path.open("rb") as file:
        head = file.read(len(_MAGIC))
    if head != _MAGIC:
        what = "an empty file" if not head else "no database of a ROS 2 bag"
        raise LogError(f"{path}: this is {what}; name a .db3 file as ros2 bag wrote it.")
    count = 0
    try:
        with closing(sqlite3.connect(f"{path.absolute().as_uri()}?immutable=1", uri=True)) as base:
            base.execute("PRAGMA writable_schema = ON")  # else a file that is too short is not opened at all
            texts = _definitions(base)
            for number, topic, kind, _ in base.execute("SELECT id, name, type, serialization_format FROM topics"):
                text, idl = texts.get(kind, ("", False))
                recording.open((path, number), topic, kind, decoder(kind, text, ros=2, idl=idl))
            last = _last(base)
            for number, received, raw in base.execute("SELECT topic_id, timestamp, data FROM messages ORDER BY rowid"):
                count += 1
                if not recording.take((path, number), received, _plain(raw)):
                    recording.cannot_decode(f"message {count}")
                if count % _TELL_EVERY == 0:
                    ask.tell(min(1.0, count / last))
    except LogError:  # what takes the parts says so
        raise
    except (sqlite3.Error, TypeError, ValueError, OverflowError) as error:
        recording.damage.append(
            Damage(f"the database {path.name} can be read no further ({error}), it ends", f"message {count}")
        )


def _last(base: sqlite3.Connection) -> int:
    """How many messages there seem to be; 1 where that part of the database is broken."""
    try:
        return int(base.execute("SELECT max(rowid) FROM messages").fetchone()[0] or 1)
    except sqlite3.Error:
        return 1


def _definitions(base: sqlite3.Connection) -> dict[str, tuple[str, bool]]:
    """Texts of message types, and whether they are IDL; bags of before 2023 have none."""
    try:
        rows = base.execute("SELECT topic_type, encoding, encoded_message_definition FROM message_definitions")
        return {kind: (text, encoding == "ros2idl") for kind, encoding, text in rows}
    except sqlite3.OperationalError:
        return {}


def _plain(raw: Any) -> bytes:
    if isinstance(raw, bytes) and raw.startswith(_ZSTD):
        import zstandard

        return zstandard.decompress(raw)
    return bytes(raw)


FORMAT = Format("ROS 2 bag", ("*.db3",), remembering(read_bag2), leader=first_part, parts=True)
