"""The channel groups of an ASAM MDF file, by asammdf: all of it, or of one stretch of time."""

import logging
import os
import warnings
from functools import lru_cache
from pathlib import Path
from typing import Any

import numpy as np

from sensorfault.logs.readers.native import native
from sensorfault.logs.readers.source import PART
from sensorfault.logs.readers.subprocess_reader import Loaded, reason

TIME = "time"


def load(path: str, part: int | None = None) -> Loaded:
    """The groups with two rows or more and numbers in them, on Unix time.

    In the second result: "units" of each group, "others": how many channels are not numbers, "lost": why groups cannot
    be read, "parts": the number of time intervals with about PART numbers each, "frames": whether it holds frames of a
    bus that were not decoded. `part`: one of the intervals, or all.

    Raises:
        Exception: of any kind, if the file is damaged.
    """
    about = os.stat(path)
    file = _opened(path, about.st_mtime_ns, about.st_size)
    groups: dict[str, dict[str, np.ndarray]] = {}
    lost = [] if part is None else file.cut()
    result: dict[str, Any] = {"units": {}, "others": 0, "lost": lost, "parts": file.parts}
    result["frames"] = _has_frames(file.file)
    for index, name in file.names.items():
        try:
            columns, units, others = file.group(index, *file.rows(index, part))
        except Exception as error:
            result["lost"].append([name, reason(error)])
            continue
        if len(columns) > 1:
            groups[name], result["units"][name] = columns, units
            result["others"] += others
    return Loaded(groups, result)


@lru_cache(maxsize=1)
def _opened(path: str, changed_ns: int, size: int) -> "_File":
    """The file, which is open until another is asked for."""
    return _File(path)


class _File:
    """`names`: of the groups with a clock and two rows or more, by number. `parts`: as `load` tells them."""

    def __init__(self, path: str) -> None:
        self.file = _mdf(path)
        self.start = self.file.start_time.timestamp()
        self.names: dict[int, str] = {}
        for index, group in enumerate(self.file.groups):
            if self.file.masters_db.get(index) is not None and group.channel_group.cycles_nr >= 2:
                self.names[index] = _name(group, index, self.names)
        self.parts = 1
        self._bounds = np.empty(0)
        self._taken: dict[int, tuple[int, int]] = {}  # the last part of each group, and how many rows are taken

    def cut(self) -> list[list[str]]:
        """Find the ends of the parts; returns the groups that have none, which are left out, and why."""
        if len(self._bounds):
            return []
        ends, lost, numbers = [], [], 0
        for index, name in list(self.names.items()):
            try:
                ends += [self._time(index, row) for row in (0, -1)]
                numbers += len(self.file.groups[index].channels) * self._count(index)
            except Exception as error:
                lost.append([name, reason(error)])
                del self.names[index]
        self.parts = max(1, -(-numbers // PART))
        self._bounds = np.linspace(min(ends, default=0.0), max(ends, default=0.0), self.parts + 1)
        return lost

    def rows(self, index: int, part: int | None) -> tuple[int, int]:
        """The first row of a group that is of a part, and how many are; each row is of one part."""
        if part is None:
            return 0, self._count(index)
        before, first = self._taken.get(index, (-1, 0))
        if before != part - 1:
            first = self._first(index, self._bounds[part])
        end = self._first(index, self._bounds[part + 1]) if part + 1 < self.parts else self._count(index)
        self._taken[index] = part, max(first, end)
        return first, max(first, end) - first

    def _count(self, index: int) -> int:
        return int(self.file.groups[index].channel_group.cycles_nr)

    def _time(self, index: int, row: int) -> float:
        """When a row of a group was recorded, -1 the last [s since the beginning]."""
        row %= self._count(index)
        return float(native(self.file.get_master(index, record_offset=row, record_count=1))[0])

    def _first(self, index: int, time: float) -> int:
        """The first row that is no earlier than a time; rows are in the order of time."""
        low, high = 0, self._count(index)
        while low < high:
            middle = (low + high) // 2
            low, high = (middle + 1, high) if self._time(index, middle) < time else (low, middle)
        return low

    def group(self, index: int, first: int, count: int) -> tuple[dict[str, np.ndarray], dict[str, str], int]:
        """The channels of a group that are single numbers, in these rows, their units, and the count of others."""
        if count < 1:
            return {}, {}, 0
        rows = {"record_offset": first, "record_count": count}
        columns, units, others = {TIME: self.start + native(self.file.get_master(index, **rows))}, {}, 0
        for number in range(len(self.file.groups[index].channels)):
            if number == self.file.masters_db[index]:
                continue
            signal = self.file.get(group=index, index=number, **rows)
            if signal.samples.ndim != 1 or signal.samples.dtype.kind not in "biuf":
                others += 1
                continue
            if len(signal.samples) != len(columns[TIME]):
                raise ValueError(f"its channel '{signal.name}' has not as many values as its clock")
            value = native(signal.samples)
            if signal.invalidation_bits is not None:
                value = np.where(signal.invalidation_bits, np.nan, value)
            columns[signal.name], units[signal.name] = value, str(signal.unit)
        return columns, units, others


def _mdf(path: str) -> Any:
    """The file; frames of a CAN bus in it are decoded by the databases beside it."""
    logging.disable()
    warnings.simplefilter("ignore")
    from asammdf import MDF  # lazily: a second that only this format needs

    file = MDF(path)
    databases = sorted(str(one) for one in Path(path).parent.glob("*.dbc"))
    if not _has_frames(file) or not databases:
        return file
    return file.extract_bus_logging(database_files={"CAN": [(one, 0) for one in databases]})


def _has_frames(file: Any) -> bool:
    return bool(getattr(file, "bus_logging_map", {}).get("CAN"))


def _name(group: Any, index: int, taken: dict[int, str]) -> str:
    """What its writer calls it; else its number."""
    called = str(group.channel_group.acq_name or group.channel_group.comment or "").strip()
    called = called if called and len(called) < 40 and "<" not in called else f"group_{index + 1}"
    return called if called not in taken.values() else f"{called}_{index + 1}"
