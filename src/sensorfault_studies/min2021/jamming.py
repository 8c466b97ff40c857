"""Inject frozen positions while the car moves, as many as fit, into the part of a drive not used for the fit."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Int

from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs import read
from sensorfault.logs.table import Log
from sensorfault.vehicles.car import LEAST_SPEED, Roles, moving, roles
from sensorfault_studies.data import real

LEARN = 0.6
RECOVERY_S = 1.0  # this long after a fault is not scored [s]
WARM_S = 3.0  # nor is the beginning [s]
PAUSE = (1.0, 2.0)  # healthy time after a fault and its recovery, in lengths of the fault, uniform between these


@dataclass(frozen=True)
class Drive:
    """A real drive: the training part, the rest, and the rows of the rest with a new position."""

    name: str
    learn: Log
    rest: Log
    roles: Roles

    @classmethod
    def read(cls, name: str, folder: str) -> "Drive":
        log = read(real(folder))
        cut = float(log.time[0]) + LEARN * log.duration_s
        return cls(name, log.between(end_s=cut), log.between(cut), roles(log))

    @property
    def position(self) -> tuple[int, int]:
        assert self.roles.position is not None
        return self.roles.position

    @property
    def fixes(self) -> Int[np.ndarray, " N"]:
        """Rows with a new position, after the start of all methods."""
        warm = self.rest.time >= self.rest.time[0] + WARM_S
        return np.flatnonzero(self.rest.fresh[:, self.position[0]] & warm)


@dataclass(frozen=True)
class Jammed:
    """A copy of the rest with frozen positions; which of its fixes are frozen, and which are scored."""

    log: Log
    onsets: tuple[float, ...]
    frozen: Bool[np.ndarray, " N"]
    scored: Bool[np.ndarray, " N"]


def onsets(drive: Drive, length_s: float, seed: int) -> tuple[float, ...]:
    """Onsets of as many faults as fit, with the car faster than LEAST_SPEED throughout; the seed shifts them."""
    rest, rng = drive.rest, np.random.default_rng([seed, round(10 * length_s)])
    assert drive.roles.velocity is not None
    received = rest.time[rest.fresh[:, drive.roles.velocity[0]]]
    slow = np.setdiff1d(received, moving(rest, drive.roles, LEAST_SPEED))
    time = float(rest.time[0]) + WARM_S + float(rng.uniform(0.0, length_s + 1.0))
    found: list[float] = []
    while time + length_s + RECOVERY_S < received[-1]:
        stops = slow[(slow >= time - RECOVERY_S / 2) & (slow < time + length_s)]
        if stops.size:
            time = float(stops[-1]) + RECOVERY_S / 2 + 1e-3
        else:
            found.append(time)
            time += length_s + RECOVERY_S + length_s * float(rng.uniform(*PAUSE))
    return tuple(found)


def jammed(drive: Drive, length_s: float, seed: int, channels: Sequence[str] = ("latitude", "longitude")) -> Jammed:
    """The receiver's `channels` frozen: at each of its epochs they repeat the value before the onset."""
    sensor = drive.rest.channels[drive.position[0]].sensor
    at = onsets(drive, length_s, seed)
    faults = [Fault("frozen", sensor, name, onset, length_s) for onset in at for name in channels]
    log = inject(drive.rest, faults, seed).log if faults else drive.rest
    time = drive.rest.time[drive.fixes]
    frozen, scored = np.zeros(len(time), bool), np.ones(len(time), bool)
    for onset in at:
        frozen |= (time >= onset) & (time < onset + length_s)
        scored &= ~((time >= onset + length_s) & (time < onset + length_s + RECOVERY_S))
    return Jammed(log, at, frozen, scored)
