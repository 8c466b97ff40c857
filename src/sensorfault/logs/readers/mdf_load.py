"""The channel groups of an ASAM MDF file, by asammdf."""

import logging
import warnings
from typing import Any

import numpy as np

from sensorfault.logs.readers.apart import Loaded, reason
from sensorfault.logs.readers.native import native

TIME = "time"


def load(path: str) -> Loaded:
    """The groups with two rows or more and numbers in them, on Unix time.

    `told`: "units" of each group, "others": how many channels are no numbers, "lost": why groups cannot be read.

    Raises:
        Exception: of any kind, if the file is damaged.
    """
    logging.disable()
    warnings.simplefilter("ignore")
    from asammdf import MDF  # lazily: a second that only this format needs

    file = MDF(path)
    groups: dict[str, dict[str, np.ndarray]] = {}
    told: dict[str, Any] = {"units": {}, "others": 0, "lost": []}
    start = file.start_time.timestamp()
    for index, group in enumerate(file.groups):
        name = _name(group, index, groups)
        try:
            columns, units, others = _group(file, index, start)
        except Exception as error:
            told["lost"].append([name, reason(error)])
            continue
        if len(columns) > 1:
            groups[name], told["units"][name] = columns, units
            told["others"] += others
    return Loaded(groups, told)


def _name(group: Any, index: int, taken: dict[str, Any]) -> str:
    """What its writer calls it; else its number."""
    called = str(group.channel_group.acq_name or group.channel_group.comment or "").strip()
    called = called if called and len(called) < 40 and "<" not in called else f"group_{index + 1}"
    return called if called not in taken else f"{called}_{index + 1}"


def _group(file: Any, index: int, start: float) -> tuple[dict[str, np.ndarray], dict[str, str], int]:
    """The channels of one group that are single numbers, their units, and how many others there are."""
    master = file.masters_db.get(index)
    if master is None or file.groups[index].channel_group.cycles_nr < 2:
        return {}, {}, 0
    columns, units, others = {TIME: start + native(file.get_master(index))}, {}, 0
    for number in range(len(file.groups[index].channels)):
        if number == master:
            continue
        signal = file.get(group=index, index=number)
        if signal.samples.ndim != 1 or signal.samples.dtype.kind not in "biuf":
            others += 1
            continue
        value = native(signal.samples)
        if signal.invalidation_bits is not None:
            value = np.where(signal.invalidation_bits, np.nan, value)
        columns[signal.name], units[signal.name] = value, str(signal.unit)
    return columns, units, others
