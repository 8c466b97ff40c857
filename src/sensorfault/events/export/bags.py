"""Write events as diagnostic_msgs/DiagnosticArray to a ROS bag, with rosbags."""

import shutil
import tempfile
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from sensorfault.events.event import Event
from sensorfault.events.export.moments import NS, Moment, moments, sentence
from sensorfault.logs.table import Log, LogError

TOPIC = "/diagnostics"
_TYPE = "diagnostic_msgs/msg/DiagnosticArray"
_OK, _ERROR = 0, 2  # DiagnosticStatus


def write_bag1(events: Sequence[Event], log: Log, path: Path, source: Path | None) -> None:
    """A bag of ROS 1: one array when an event begins (level ERROR) and one when it ends (level OK)."""
    from rosbags.rosbag1 import Writer
    from rosbags.typesys import Stores, get_typestore

    path.unlink(missing_ok=True)  # rosbags refuses to overwrite a file
    store = get_typestore(Stores.ROS1_NOETIC)
    with Writer(path) as writer:
        connection = writer.add_connection(TOPIC, _TYPE, typestore=store)
        for number, moment in enumerate(moments(events, log)):
            raw = store.serialize_ros1(_array(store, moment, {"seq": number}), _TYPE)
            writer.write(connection, moment.time_ns, raw)


def write_bag2(events: Sequence[Event], log: Log, path: Path, source: Path | None) -> None:
    """A bag of ROS 2 (a folder) with the same messages."""
    from rosbags.rosbag2 import Writer
    from rosbags.typesys import Stores, get_typestore

    store = get_typestore(Stores.LATEST)
    with Writer(path, version=9) as writer:
        connection = writer.add_connection(TOPIC, _TYPE, typestore=store)
        for moment in moments(events, log):
            writer.write(connection, moment.time_ns, store.serialize_cdr(_array(store, moment, {}), _TYPE))


def appear(path: Path, write: Callable[[Path], None]) -> None:
    """Write a folder, whole or not at all.

    Raises:
        LogError: it exists already.
    """
    with tempfile.TemporaryDirectory(dir=path.parent, prefix=f".{path.name}.") as near:
        folder = Path(near) / path.name
        write(folder)
        if path.exists():
            raise LogError(f"{path} exists already; give a new folder for the bag.")
        shutil.move(folder, path)


def _array(store: Any, moment: Moment, sequence: dict[str, int]) -> Any:
    """One DiagnosticArray."""
    types, event = store.types, moment.event
    stamp = types["builtin_interfaces/msg/Time"](sec=moment.time_ns // NS, nanosec=moment.time_ns % NS)
    pair = types["diagnostic_msgs/msg/KeyValue"]
    status = types["diagnostic_msgs/msg/DiagnosticStatus"](
        level=_ERROR if moment.begins else _OK,
        name=f"sensorfault: {event.where}",
        message=sentence(event, moment.begins),
        hardware_id=event.sensor or "",
        values=[pair(key=key, value="" if value is None else str(value)) for key, value in event.as_dict().items()],
    )
    header = types["std_msgs/msg/Header"](**sequence, stamp=stamp, frame_id="")
    return types[_TYPE](header=header, status=[status])
