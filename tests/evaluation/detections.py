"""Detections made by hand: a quiet log of one gyro and one GNSS receiver, and whatever events one likes."""

from collections.abc import Sequence

import numpy as np

from sensorfault.core.verdicts import UNKNOWN
from sensorfault.events.event import Event
from sensorfault.logs.table import Channel, Log, Sensor
from sensorfault.runtime.result import Detection

TICK_S = 0.1
CHANNELS = (Channel("x", "gyro"), Channel("y", "gyro"), Channel("east", "gnss"))
SENSORS = (Sensor("gyro", TICK_S), Sensor("gnss", TICK_S))


def quiet(duration_s: float = 1000.0, start_s: float = 0.0) -> Log:
    """Channel c is a square wave of standard deviation c + 1."""
    time = start_s + np.arange(round(duration_s / TICK_S) + 1) * TICK_S
    wave = np.where(np.arange(len(time)) % 2, 1.0, -1.0)[:, None] * np.arange(1.0, 4.0)
    return Log(time, wave, np.ones(wave.shape, bool), CHANNELS, SENSORS, "quiet")


def event(
    start_s: float,
    end_s: float | None = None,
    sensor: str | None = "gyro",
    channel: str | None = "x",
    kind: str = "offset",
    limit: float | None = 1.0,
) -> Event:
    return Event(start_s, end_s, "sensor", sensor, channel, kind, 2.0, limit, "hand")


def detection(events: Sequence[Event] = (), log: Log | None = None, repaired: np.ndarray | None = None) -> Detection:
    log = log or quiet()
    verdict = np.zeros(log.value.shape, np.int8)
    return Detection(
        log=log,
        method="hand",
        watched=(True,) * verdict.shape[1],
        channel=verdict,
        sensor=verdict[:, :2],
        sample=verdict[:, 0],
        motion=np.full(len(verdict), UNKNOWN, np.int8),
        repaired=log.value if repaired is None else repaired,
        traces=(),
        events=tuple(events),
    )
