"""Faults as text: one on the command line, the truth of a log as JSON."""

import json
import re
from collections.abc import Iterable
from typing import Any

from sensorfault.faults.check import check_fault, check_onset, columns_of
from sensorfault.faults.fault import KINDS, SIZELESS, Fault, FaultError, current_kind
from sensorfault.logs.table import Log

FORM = "kind:sensor[.channel]:onset_s:duration_s[:magnitude[sigma]]"


def parse_fault(text: str, log: Log | None = None) -> Fault:
    """`"offset:gyro.z:120:20:5sigma"` -> an offset of five sigmas on gyro.z from 120 s for 20 s.

    With `log`, the sensor, the channel and the onset are checked too.

    Raises:
        FaultError: the text has another form, or is no fault (in this log).
    """
    parts = text.strip().split(":")
    if len(parts) not in (4, 5):
        raise FaultError(f"Fault '{text}' has {len(parts)} parts; write {FORM}.")
    kind, where, onset, duration, size = (part.strip() for part in (*parts, "")[:5])
    kind = current_kind(kind)
    sensor, _, channel = where.partition(".")
    if not sensor:
        raise FaultError(f"Fault '{text}' names no sensor; write {FORM}.")
    if not size and kind in KINDS and kind not in SIZELESS:
        raise FaultError(f"Fault '{text}': kind {kind} needs a magnitude; write {FORM}.")
    if size and kind in SIZELESS:
        raise FaultError(f"Fault '{text}': kind {kind} has no magnitude; leave out ':{size}'.")
    bare = re.sub(r"\s*(sigmas?|σ)$", "", size)
    fault = Fault(
        kind=kind,
        sensor=sensor,
        channel=channel or None,
        start_s=_number(onset, "onset", text),
        duration_s=_number(duration, "duration", text),
        magnitude=_number(bare, "magnitude", text) if size else 0.0,
        sigmas=bare != size,
    )
    check_fault(fault)
    if log is not None:
        columns_of(fault, log)
        check_onset(fault, log)
    return fault


def truth_to_json(truth: Iterable[Fault]) -> str:
    """A JSON list with one object per fault; the keys are the fields of `Fault`."""
    return json.dumps([fault.as_dict() for fault in truth], indent=1)


def truth_from_json(text: str) -> tuple[Fault, ...]:
    """Read what `truth_to_json` wrote.

    Raises:
        FaultError: not JSON, not a list of faults, or a fault with a missing, unknown or invalid field.
    """
    try:
        entries = json.loads(text)
    except json.JSONDecodeError as error:
        raise FaultError(f"The truth is not JSON ({error.msg}, line {error.lineno}); write a list of faults.") from None
    except RecursionError:
        raise FaultError("The truth is JSON nested without end; write a list of faults.") from None
    if not isinstance(entries, list):
        raise FaultError(f"The truth is a JSON {type(entries).__name__}; write a list of faults.")
    return tuple(_fault(entry, i) for i, entry in enumerate(entries, start=1))


def _number(text: str, what: str, whole: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise FaultError(f"Fault '{whole}': {what} '{text}' is not a number; write {FORM}.") from None


_TYPES: dict[str, tuple[type, ...]] = {
    "kind": (str,),
    "sensor": (str,),
    "channel": (str, type(None)),
    "start_s": (int, float),
    "duration_s": (int, float),
    "magnitude": (int, float),
    "sigmas": (bool,),
}


def _fault(entry: Any, number: int) -> Fault:
    """One entry of the list, checked field by field."""
    if not isinstance(entry, dict):
        raise FaultError(f"Fault {number} of the truth is not a JSON object; write one with {', '.join(_TYPES)}.")
    optional: dict[str, Any] = {"magnitude": 0.0, "sigmas": False, "channel": None}
    if foreign := sorted(set(entry) - set(_TYPES)):
        raise FaultError(f"Fault {number} of the truth has an unknown field '{foreign[0]}'; leave it out.")
    full = optional | entry
    for name, types in _TYPES.items():
        if name not in full:
            raise FaultError(f"Fault {number} of the truth has no field '{name}'; add it.")
        wrong = not isinstance(full[name], types) or (isinstance(full[name], bool) and bool not in types)
        if wrong:
            raise FaultError(f"Fault {number} of the truth: '{name}' is {json.dumps(full[name])}; correct its type.")
    full |= {name: float(full[name]) for name, types in _TYPES.items() if float in types}
    fault = Fault(**full)
    check_fault(fault)
    return fault
