"""u-blox's RXM-RAWX: what a receiver measured of each satellite."""

import struct
from collections.abc import Iterator

import numpy as np
from jaxtyping import Bool

from sensorfault.logs.readers.gnss.observed import Observed, name_of, observed
from sensorfault.numerics.gnss.constants import B3I_HZ, WEEK_S

SYSTEMS = {0: "G", 1: "S", 2: "E", 3: "C", 5: "J", 6: "R"}
_NO_NUMBER = 255  # of a GLONASS satellite that is not known yet
# Signals on the first frequency; of BeiDou, whose newer receivers leave B1I out, those on B3I instead.
_BANDS = {
    "G": ((0,),), "S": ((0,),), "E": ((0, 1),), "C": ((0, 1), (4, 10)), "J": ((0,),), "R": ((0,),)
}  # fmt: skip
_MEASUREMENT = np.dtype(
    [
        ("pseudorange", "<f8"), ("phase", "<f8"), ("doppler", "<f4"), ("system", "u1"), ("satellite", "u1"),
        ("signal", "u1"), ("slot", "u1"), ("lock", "<u2"), ("cn0", "u1"), ("sigma", "u1"), ("phase_sigma", "u1"),
        ("doppler_sigma", "u1"), ("status", "u1"), ("reserved", "u1"),
    ]
)  # fmt: skip
_HEAD = struct.Struct("<dHbBBBH")


def measured(raw: list[bytes]) -> Observed:
    """The measurements of one frequency of each system; a payload that is no whole epoch is left out."""
    times, epochs = [], []
    for time, epoch in _epochs(raw):
        times.append(time)
        epochs.append(epoch)
    every = np.concatenate([np.empty(0, _MEASUREMENT), *epochs])
    at = np.repeat(np.arange(len(times)), [len(epoch) for epoch in epochs])
    chosen = np.zeros(len(every), bool)
    frequency = {}
    for system in SYSTEMS:
        received, second = _heard(every, system)
        chosen |= received
        if second:
            frequency[SYSTEMS[system]] = B3I_HZ
    every, at = every[chosen], at[chosen]
    names: dict[str, int] = {}
    satellite = [
        names.setdefault(name_of(SYSTEMS[int(one["system"])], int(one["satellite"])), len(names)) for one in every
    ]
    values = {
        "pseudorange_m": every["pseudorange"].tolist(),
        "doppler_hz": every["doppler"].tolist(),
        "cn0_dbhz": every["cn0"].tolist(),
        "sigma_m": (0.01 * 2.0 ** (every["sigma"] & 15)).tolist(),  # σ = 0.01 · 2ⁿ m
    }
    return observed(times, list(names), at.tolist(), satellite, values, frequency)


def _epochs(raw: list[bytes]) -> Iterator[tuple[float, np.ndarray]]:
    """The time [s of GPS time] and the measurements of each whole epoch that is later than the one before."""
    before = -np.inf
    for payload in raw:
        head = _HEAD.unpack_from(payload) if len(payload) >= _HEAD.size else None
        if head is None or not 0 <= head[0] < WEEK_S or len(payload) < _HEAD.size + head[3] * _MEASUREMENT.itemsize:
            continue
        time = head[1] * WEEK_S + head[0]
        if time > before:
            yield time, np.frombuffer(payload, _MEASUREMENT, head[3], _HEAD.size)
            before = time


def _heard(every: np.ndarray, system: int) -> tuple[Bool[np.ndarray, " N"], bool]:
    """Which good measurements are of the first band received of their system, and whether that is its second band."""
    sound = (every["status"] & 1 == 1) & (every["satellite"] != _NO_NUMBER) & (every["system"] == system)
    of_bands = [sound & np.isin(every["signal"], band) for band in _BANDS[SYSTEMS[system]]]
    return next(
        ((received, band > 0) for band, received in enumerate(of_bands) if received.any()), (of_bands[0], False)
    )
