"""A small log with every way a value can be there: each tick, held, now and then, not yet."""

import numpy as np

from sensorfault.logs.table import Channel, Log, Sensor

DEGREE = np.pi / 180
GYRO_X, GYRO_Z, LATITUDE, SPEED, BARO = range(5)


def example(ticks: int = 200) -> Log:
    """Gyro each 0.1 s, fixes held from tick 3 on and new every 5th, a barometer that is only there every 4th tick."""
    rng = np.random.default_rng(7)
    time = np.arange(ticks) / 10
    value = rng.normal(size=(ticks, 5)) * [0.1, 0.2, 1e-4, 3.0, 100.0] + [0.0, 0.05, 0.9, 10.0, 1e5]
    fresh = np.ones((ticks, 5), dtype=bool)
    for t in range(ticks):
        fresh[t, 2:4] = t % 5 == 3
        fresh[t, 4] = t % 4 == 0
        if not fresh[t, 2]:
            value[t, 2:4] = value[t - 1, 2:4] if t >= 3 else np.nan
        if not fresh[t, 4]:
            value[t, 4] = np.nan
    channels = (
        Channel("x", "gyro", "deg/s"),
        Channel("z", "gyro", "deg/s"),
        Channel("latitude", "gnss", "deg", watch=False),
        Channel("speed", "gnss", "km/h"),
        Channel("pressure", "baro", "hPa"),
    )
    sensors = (Sensor("gyro", 0.1), Sensor("gnss", 0.5, held=True), Sensor("baro", 0.4))
    return Log(time, value, fresh, channels, sensors)
