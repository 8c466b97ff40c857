"""Condition (c): a car among high buildings; half of the signals are reflected, and labels say which."""

from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
from jaxtyping import Float

from sensorfault.logs import read
from sensorfault.logs.satellites import satellites
from sensorfault.logs.table import Channel, Log, Sensor
from sensorfault.numerics.gravity import gravity
from sensorfault.simulation.ride import INERTIAL
from sensorfault_studies.data import real

FOLDER = "gnss/smartloc_berlin_potsdamer_platz"
INPUT, TRUTH, LABELS = "Berlin_Potsdamer_Platz_Input.txt", "Berlin_Potsdamer_Platz_GT.txt", "RXM-RAWX.csv"
SYSTEMS = "GR"
# The labels' file begins one epoch earlier: with this shift its true positions equal the other file's to a micrometre.
LABELS_LATE_S = -0.2
SAME_S = 0.05
WHEEL = Channel("speed", "wheel", "m/s")


@dataclass(frozen=True)
class Town:
    """T epochs of S satellites. `log`: with wheel speed and the inertial unit derived from it; `bare`: satellites only.

    `nlos`: 1 for a satellite without line of sight, 0 for one in sight, NaN where unknown (after one minute).
    """

    log: Log
    bare: Log
    names: tuple[str, ...]
    position: Float[np.ndarray, "T 3"]  # ECEF [m]
    nlos: Float[np.ndarray, "T S"]
    cn0: Float[np.ndarray, "T S"]  # [dB-Hz]


def town() -> Town:
    """The drive at Potsdamer Platz, 283 s at 5 Hz.

    Raises:
        LogError: the real log does not exist.
    """
    return _town(real(FOLDER))


@cache
def _town(folder: Path) -> Town:
    log, truth, labels = (read(folder / name) for name in (INPUT, TRUTH, LABELS))
    seen = satellites(log, SYSTEMS)
    columns = [i for i, channel in enumerate(log.channels) if channel.sensor in seen.names]
    bare = log.select([log.channels[i].path for i in columns])
    position = truth.value[:, truth.of("position")]
    return Town(
        _with_wheels(log, bare, position), bare, seen.names, position, _labels(log, labels, seen.names), seen.cn0
    )


def _with_wheels(log: Log, bare: Log, position: Float[np.ndarray, "T 3"]) -> Log:
    """Add an inertial unit derived from speed and turn rate: it stays level and turns only about the vertical axis.

    Source: for such reduced systems A. Noureldin et al., Fundamentals of Inertial Navigation (2013), chapter 9.
    """
    speed, turn = log.value[:, log.index("odometry.x")], -log.value[:, log.index("gyro.z")]
    nothing = np.zeros(len(log))
    ahead = np.diff(speed, prepend=speed[0]) / np.diff(log.time, prepend=log.time[0] - log.period_s)
    weight = np.full(len(log), np.linalg.norm(gravity(position[0])))
    derived = np.stack([nothing, nothing, turn, ahead, speed * turn, -weight, speed], axis=1)
    own = tuple(Sensor(name, log.period_s) for name in ("gyro", "accelerometer", "wheel"))
    return Log(
        log.time,
        np.concatenate([derived, bare.value], axis=1),
        np.concatenate([np.isfinite(derived), bare.fresh], axis=1),
        (*INERTIAL, WHEEL, *bare.channels),
        (*own, *bare.sensors),
        "smartLoc",
    )


def _labels(log: Log, labels: Log, names: tuple[str, ...]) -> Float[np.ndarray, "T S"]:
    """Each label at its tick of the log."""
    at = labels.time + LABELS_LATE_S
    tick = np.abs(log.time[None] - at[:, None]).argmin(axis=1)
    same = np.abs(log.time[tick] - at) < SAME_S
    known = {channel.sensor: i for i, channel in enumerate(labels.channels) if channel.name == "nlos"}
    nlos = np.full((len(log), len(names)), np.nan)
    for j, name in enumerate(names):
        if name in known:
            nlos[tick[same], j] = labels.value[same, known[name]]
    return nlos
