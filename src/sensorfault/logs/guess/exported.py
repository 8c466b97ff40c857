"""A folder of PX4's topics, one CSV each, as pyulog's ulog2csv writes it: `flight_sensor_combined_0.csv`."""

import re
from collections.abc import Iterable
from pathlib import Path

from sensorfault.logs.guess.autopilots import PX4

_TOPICS = sorted(PX4.tables, key=len, reverse=True)
_NAME = re.compile(rf"(?:^|_)(?P<topic>{'|'.join(_TOPICS)})_(?P<instance>\d+)$")


def topics_of(files: Iterable[Path]) -> dict[str, Path]:
    """The files by topic, `sensor_baro[1]` for the second instance of one; none if it is no such folder."""
    found: dict[str, Path] = {}
    for file in files:
        named = _NAME.search(file.stem) if file.suffix.lower() == ".csv" else None
        if named:
            instance = int(named["instance"])
            found[named["topic"] + (f"[{instance}]" if instance else "")] = file
    return found if PX4.tells & found.keys() and len(found) > 1 else {}
