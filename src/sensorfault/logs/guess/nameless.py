"""Columns without names: what they are by their values."""

import re
from itertools import pairwise

import numpy as np
import polars as pl
from jaxtyping import Float

from sensorfault.logs.guess.words import Meaning
from sensorfault.logs.readers.source import Source
from sensorfault.logs.units import STANDARD_GRAVITY

_STEADY = 0.15  # relative spread below which three axes have a steady length
_OF_LENGTH_1, _NEARLY_ALL = 0.01, 0.99
_OF_A_DRIVE_DEG = 2.0  # so far a drive goes at most
_RECEIVER = re.compile(r"(^|[^a-z])(gps|gnss)([^a-z]|$)", re.IGNORECASE)


def is_nameless(names: list[str]) -> bool:
    """Whether columns have no names but those that readers give them."""
    return bool(names) and all(re.fullmatch(r"c\d+", name) for name in names)


def placed(source: Source, time: str | None) -> dict[str, Meaning]:
    """What columns without names are together: a trajectory (TUM), or the fix of a receiver."""
    names = [name for name in source.frame.columns if name != time]
    if not is_nameless(names):
        return {}
    value = np.column_stack(
        [source.frame[name].cast(pl.Float64, strict=False).fill_null(np.nan).to_numpy() for name in names]
    )
    return _trajectory(names, value) or _fix(source, names, value)


def _trajectory(names: list[str], value: Float[np.ndarray, "T C"]) -> dict[str, Meaning]:
    """A position, and a quaternion, which has length 1."""
    if len(names) != 7:
        return {}
    length = np.linalg.norm(value[:, 3:], axis=1)
    if not (np.abs(length[np.isfinite(length)] - 1) < _OF_LENGTH_1).mean() > _NEARLY_ALL:
        return {}
    kinds = [("local_position", axis) for axis in "xyz"] + [("quaternion", axis) for axis in "xyzw"]
    return {name: Meaning(kind, axis, "", "") for name, (kind, axis) in zip(names, kinds, strict=True)}


def _fix(source: Source, names: list[str], value: Float[np.ndarray, "T C"]) -> dict[str, Meaning]:
    """The first two neighbours in a table called after a receiver that may be a latitude and a longitude."""
    if _RECEIVER.search(f"{source.table or ''} {source.path.stem}") is None:
        return {}
    for i, (one, other) in enumerate(pairwise(names)):
        if _are_degrees(value[:, i], 90.0) and _are_degrees(value[:, i + 1], 180.0):
            return {one: Meaning("position", "latitude", "", ""), other: Meaning("position", "longitude", "", "")}
    return {}


def _are_degrees(value: Float[np.ndarray, " T"], most: float) -> bool:
    """Whether values lie near each other on the earth and are written with more than three decimals."""
    known = value[np.isfinite(value)]
    if not len(known) or not 0 < np.abs(known).max() <= most or np.ptp(known) > _OF_A_DRIVE_DEG:
        return False
    return bool((known != np.round(known, 3)).any())


def by_gravity(value: Float[np.ndarray, "T C"]) -> list[tuple[str, str]]:
    """Kind and axis of each column: three neighbours as long as gravity are an accelerometer, the next three a gyro.

    A column that is neither has no kind.
    """
    found: list[tuple[str, str]] = []
    gyro_due = False
    while (at := len(found)) < value.shape[1]:
        triple, next_three = value[:, at : at + 3], value[:, at + 3 : at + 6]
        if _is_gravity(triple):
            kind, gyro_due = "accelerometer", True
        elif triple.shape[1] == 3 and (gyro_due or _is_gravity(next_three)):
            kind, gyro_due = "gyro", False
        else:
            found.append(("", ""))
            continue
        found += [(kind, axis) for axis in "xyz"]
    return found


def _is_gravity(triple: Float[np.ndarray, "T _"]) -> bool:
    """Whether the usual length of three columns is 1 g, 9.8 m/s^2 or 1000 mg, and steady."""
    if triple.shape[1] != 3:
        return False
    length = np.linalg.norm(triple, axis=1)
    middle = float(np.nanmedian(length))
    steady = float(np.nanmedian(np.abs(length - middle))) < _STEADY * middle
    return steady and any(0.8 < middle / gravity < 1.25 for gravity in (1.0, STANDARD_GRAVITY, 1000.0))
