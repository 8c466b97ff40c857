"""What no vehicle of a class can do: one sample of a height alone, speeds and climb rates beyond all use."""

from collections.abc import Iterator

import numpy as np

from sensorfault.relations.grid import Grid
from sensorfault.relations.levels.finding import Finding, device_of, worst
from sensorfault.relations.levels.windows import windows
from sensorfault.relations.signals import Signal

SPIKE_M = {"copter": 30.0, "wing": 40.0, "car": 30.0, "rail": 60.0}
CLIMB_M_S = {"copter": 35.0, "wing": 60.0, "car": 15.0, "rail": 15.0}
SPEED_M_S = {"copter": 45.0, "wing": 80.0, "car": 70.0, "rail": 150.0, "underwater": 10.0}
RISE_M_S = {"copter": 25.0, "wing": 40.0, "car": 12.0, "rail": 20.0, "underwater": 5.0}


def findings(grid: Grid, vehicle: str) -> Iterator[Finding]:
    """Of barometers and receivers."""
    for signal in grid.signals.values():
        if signal.role == "barometer":
            yield from _height(signal, vehicle, "barometer")
        elif signal.role == "gnss.height":
            yield from _height(signal, vehicle, "height")
        elif signal.role in ("gnss.velocity", "gnss.speed"):
            speed = np.linalg.norm(signal.value, axis=1)
            yield from _beyond(signal, speed, SPEED_M_S.get(vehicle, 100.0), "speed that no such vehicle has")
        elif signal.role == "gnss.climb":
            climb = np.abs(signal.value[:, 0])
            yield from _beyond(signal, climb, RISE_M_S.get(vehicle, 60.0), "climb rate that no such vehicle has")


def _height(signal: Signal, vehicle: str, what: str) -> Iterator[Finding]:
    device, h, time = device_of(signal), signal.value[:, 0], signal.time
    if len(h) < 6:
        return
    back, ahead = h[1:-1] - h[:-2], h[1:-1] - h[2:]
    close = (np.diff(time)[:-1] < 2.5) & (np.diff(time)[1:] < 2.5)
    spike = np.where((back * ahead > 0) & close, np.minimum(np.abs(back), np.abs(ahead)), 0.0)
    limit = SPIKE_M.get(vehicle, 40.0)
    for i in np.flatnonzero(spike > limit):
        yield Finding(
            device,
            float(time[i + 1]),
            float(time[i + 1]),
            f"one sample of {what} alone",
            float(spike[i]),
            limit,
            "spike",
        )
    if what == "barometer":
        at, mean, _ = windows(time, h, 1.0)
        if len(at) > 2:
            rate = np.abs(np.diff(mean)) / np.diff(at) * (np.diff(at) < 1.6)
            lone = np.interp(at[1:], time[1:-1], spike) > limit  # a spike moves the mean of its second
            wide = np.array([((time[1:-1] > t - 2.1) & (time[1:-1] < t + 1.1) & (spike > limit)).any() for t in at[1:]])
            yield from worst(
                device,
                at[1:],
                np.where(lone | wide, 0.0, rate),
                CLIMB_M_S.get(vehicle, 60.0),
                60.0,
                "climb rate that no such vehicle has",
                1.0,
            )


def _beyond(signal: Signal, value: np.ndarray, limit: float, test: str) -> Iterator[Finding]:
    yield from worst(device_of(signal), signal.time, value, limit, 5.0, test)
