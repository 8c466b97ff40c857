"""A simulated flight that several test files share: heights at 5 Hz on a clock of 5 or 25 Hz."""

from functools import cache

import numpy as np

from sensorfault.logs.table import Channel, Log, Sensor

FIX_S = 0.2
CHANNELS = (
    Channel("altitude", "gnss", "m", watch=False),
    Channel("down", "gnss", "m/s"),
    Channel("altitude", "barometer", "m", watch=False),
    Channel("pitch", "attitude", "rad"),
    Channel("throttle", "control", ""),
)
HEIGHT, DOWN, BARO, PITCH, THROTTLE = range(5)


@cache
def flight(duration_s: float = 240.0, seed: int = 0, hz: float = 5.0) -> Log:
    """Climbs and descents by a pitch that swings; bounded noise; the receiver's channels are new every FIX_S, the rest
    with every tick.
    """
    random = np.random.default_rng(seed)
    time = np.arange(round(duration_s * hz)) / hz
    phase = random.uniform(0, 6, 3)
    pitch = (np.sin(np.outer(time, (0.31, 0.73, 1.1)) + phase) * [0.10, 0.05, 0.03]).sum(axis=1)
    throttle = 0.5 + 0.3 * np.sin(0.31 * time + phase[0] + 0.2)
    climb = 15.0 * np.sin(pitch) + 1.5 * (throttle - 0.5)
    height = 300.0 + np.concatenate([[0.0], np.cumsum((climb[1:] + climb[:-1]) / 2 / hz)])
    truth = np.column_stack([height, -climb, height - 70.0, pitch, throttle])
    value = truth + random.uniform(-1, 1, truth.shape) * [0.08, 0.05, 0.2, 2e-3, 1e-3]
    every = max(round(FIX_S * hz), 1)
    fresh = np.ones(value.shape, bool)
    fresh[:, :2] = (np.arange(len(time)) % every == 0)[:, None]
    value[:, :2] = np.where(fresh[:, :2], value[:, :2], np.nan)
    sensors = tuple(
        Sensor(name, max(FIX_S, 1 / hz) if name == "gnss" else 1 / hz)
        for name in ("gnss", "barometer", "attitude", "control")
    )
    return Log(time, value, fresh, CHANNELS, sensors, f"flight {seed}")
