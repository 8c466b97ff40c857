"""Checks whether a fault can be injected into a log."""

import math

import numpy as np

from sensorfault.faults.fault import KINDS, OFFSETS, SIZELESS, Fault, FaultError
from sensorfault.logs.table import Log


def check_fault(fault: Fault) -> None:
    """Check what needs no log.

    Raises:
        FaultError: unknown kind, a number that is not finite, a duration or magnitude that is no fault.
    """
    name = f"fault '{fault.kind}' on {fault.where}"
    if fault.kind not in KINDS:
        raise FaultError(f"Fault kind '{fault.kind}' is unknown; take one of {', '.join(KINDS)}.")
    for field in ("start_s", "duration_s", "magnitude"):
        if not math.isfinite(getattr(fault, field)):
            raise FaultError(f"{name}: {field} is {getattr(fault, field)}; give a finite number.")
    if fault.duration_s < 0:
        raise FaultError(f"{name}: duration {fault.duration_s:g} s is negative; give seconds from onset to end.")
    if fault.duration_s == 0 and fault.kind != "spike":
        raise FaultError(f"{name}: duration is 0 s; only a spike may last 0 s, give a longer duration.")
    if fault.magnitude == 0 and fault.kind not in (*SIZELESS, "scale"):
        raise FaultError(f"{name}: magnitude is missing or 0; give one.")
    if fault.magnitude == 1 and fault.kind == "scale":
        raise FaultError(f"{name}: a factor of 1 is no fault; give another factor.")
    if fault.magnitude < 0 and fault.kind in ("noise", "delay"):
        raise FaultError(f"{name}: magnitude {fault.magnitude:g} is negative; give a positive one.")
    if fault.sigmas and fault.kind not in OFFSETS:
        raise FaultError(f"{name}: its magnitude cannot be in sigmas; give sigmas only for {', '.join(OFFSETS)}.")


def columns_of(fault: Fault, log: Log) -> tuple[int, ...]:
    """The columns of the log that the fault affects.

    Raises:
        FaultError: the log has no such sensor or channel.
    """
    sensors = [s.name for s in log.sensors]
    if fault.sensor not in sensors:
        raise FaultError(f"{log.name}: no sensor is called '{fault.sensor}'; take one of {', '.join(sensors)}.")
    columns = log.of(fault.sensor)
    names = [log.channels[i].name for i in columns]
    if fault.channel is None:
        return columns
    if fault.channel not in names:
        raise FaultError(
            f"{log.name}: sensor {fault.sensor} has no channel '{fault.channel}'; take one of {', '.join(names)}."
        )
    return (columns[names.index(fault.channel)],)


def check_onset(fault: Fault, log: Log) -> None:
    """Check that the fault begins within the log.

    Raises:
        FaultError: it does not.
    """
    if not len(log):
        raise FaultError(f"{log.name}: the log is empty; there is nothing to inject into.")
    first, last = log.time[0], log.time[-1]
    if not first <= fault.start_s <= last:
        raise FaultError(
            f"{log.name}: onset {fault.start_s:g} s of '{fault.kind}' on {fault.where} lies outside the log; "
            f"choose one from {first:g} to {last:g} s."
        )


def sigma_of(log: Log, column: int) -> float:
    """Standard deviation [SI] of a channel's measurements over the log.

    Raises:
        FaultError: the channel is constant or empty.
    """
    x = log.value[log.fresh[:, column], column]
    x = x[np.isfinite(x)]
    sigma = float(x.std()) if x.size else 0.0
    if sigma == 0:
        path = log.channels[column].path
        raise FaultError(f"{log.name}: {path} never changes, so it has no sigma; give the magnitude in its unit.")
    return sigma
