"""Inject faults into a log: the same log with faulty sensors, and the list of its faults.

A fault acts on measurements (the `fresh` entries of a channel). A row that repeats a measurement then repeats the
faulty one, or is empty where the measurement is gone.
"""

import json
import zlib
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Bool, Int

from sensorfault.core.expect import FAULTS, LOG, expect, expect_all
from sensorfault.faults.check import check_fault, check_onset, columns_of, sigma_of
from sensorfault.faults.fault import OFFSETS, Fault, FaultError
from sensorfault.faults.shapes import SHAPES, Struck, spikes
from sensorfault.logs.phrase import counted
from sensorfault.logs.table import Log
from sensorfault.logs.units import to_si


@dataclass(frozen=True)
class Injected:
    """A log with faults, and the truth.

    `truth`: the faults as injected, by onset: clipped to the log, a single spike at the time of its measurement.
    `mask`: the entries that a fault affects (a frozen sensor counts as faulty even where its value is right).
    """

    log: Log
    truth: tuple[Fault, ...]
    mask: Bool[np.ndarray, "T C"]

    def __repr__(self) -> str:
        return f"<Injected {counted(len(self.truth), 'fault')} in {self.log!r}>"


def inject(log: Log, faults: Iterable[Fault], seed: int = 0) -> Injected:
    """Inject faults into a log; the given log is not changed.

    Several faults on one channel are applied by onset, each to the result of the one before; the order of `faults` does
    not matter. Random numbers depend on `seed` and the fault alone, not on the other faults.

    Args:
        log: T rows, C channels.
        faults: what is done to it, in seconds of the log's clock; magnitudes in the channels' own units.
        seed: of all chance.

    Returns:
        The log with faults, the faults as they were done, and the entries (T x C) that they struck.

    Raises:
        FaultError: a fault that does not fit the log, or is no fault.
        TypeError: something else than a log, or than faults.
    """
    expect(log, Log, "inject: log", LOG)
    faults = expect_all(faults, Fault, "inject: faults", FAULTS)
    value, fresh = log.value.copy(), log.fresh.copy()
    mask = np.zeros_like(fresh)
    truth = []
    for fault in sorted(faults, key=_order):
        check_fault(fault)
        check_onset(fault, log)
        onsets = []
        for column in columns_of(fault, log):
            rng = _chance(fault, log.channels[column].path, seed)
            rows_of = np.flatnonzero(fresh[:, column])
            at = _struck(fault, log.time[rows_of], rng)
            if not at.size:
                continue
            read = Struck(log.time[rows_of], value[rows_of, column], at, fault.start_s, _size(fault, log, column), rng)
            became = np.full(len(rows_of), np.nan)
            became[at] = SHAPES[fault.kind](read)
            source = np.cumsum(fresh[:, column]) - 1  # row t repeats measurement source[t]
            rows = np.isin(source, at) & np.isfinite(value[:, column])
            value[rows, column] = became[source[rows]]
            fresh[rows, column] &= np.isfinite(value[rows, column])
            mask[rows, column] = True
            onsets.append(float(read.time[at[0]]))
        if not onsets:
            raise FaultError(
                f"{log.name}: {fault.where} has no measurement from {fault.start_s:g} to {fault.end_s:g} s for "
                f"'{fault.kind}' to act on; move the onset or make it longer."
            )
        truth.append(_as_done(fault, log, min(onsets)))
    return Injected(replace(log, value=value, fresh=fresh), tuple(truth), mask)


def _order(fault: Fault) -> tuple[float, str]:
    return fault.start_s, json.dumps(fault.as_dict())


def _chance(fault: Fault, path: str, seed: int) -> np.random.Generator:
    """Random numbers that depend on the seed, the fault and the channel."""
    return np.random.default_rng([seed, zlib.crc32(json.dumps([fault.as_dict(), path]).encode())])


def _struck(fault: Fault, time: np.ndarray, rng: np.random.Generator) -> Int[np.ndarray, " n"]:
    """Which measurements the fault affects."""
    first, end = np.searchsorted(time, (fault.start_s, fault.end_s))
    if fault.kind != "spike":
        return np.arange(first, end)
    if fault.duration_s == 0:
        return np.arange(first, min(first + 1, len(time)))
    return spikes(np.arange(first, end), rng)


def _size(fault: Fault, log: Log, column: int) -> float:
    """The magnitude in SI; sigma is that of the healthy log."""
    if fault.kind not in OFFSETS:
        return fault.magnitude
    if fault.sigmas:
        return fault.magnitude * sigma_of(log, column)
    return to_si(fault.magnitude, log.channels[column].unit)


def _as_done(fault: Fault, log: Log, onset_s: float) -> Fault:
    if fault.duration_s == 0:
        return replace(fault, start_s=onset_s)
    end_s = float(log.time[-1])
    return fault if fault.end_s <= end_s else replace(fault, duration_s=end_s - fault.start_s)
