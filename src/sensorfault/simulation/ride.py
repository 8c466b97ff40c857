"""A ride with an inertial unit and satellites: the truth at each tick, and the recorded log."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from sensorfault.logs.table import Channel, Log, Sensor
from sensorfault.numerics.gnss.constants import L1_HZ, LIGHT_M_S
from sensorfault.simulation.sky import Sky

INERTIAL = (
    *(Channel(axis, "gyro", "rad/s") for axis in "xyz"),
    *(Channel(axis, "accelerometer", "m/s^2") for axis in "xyz"),
)
_TOLD = (
    ("corrected_m", "m"),
    ("doppler_hz", "Hz"),
    ("elevation_rad", "rad"),
    *((f"{axis}_m", "m") for axis in "xyz"),
    *((f"v{axis}_m_s", "m/s") for axis in "xyz"),
)


@dataclass(frozen=True)
class Ride:
    """The truth at the T ticks of `log`, and the satellites at its E epochs.

    Body axes: forward, right, down. `log` includes `error`; a satellite was not received where `error` is NaN.
    """

    log: Log
    position: Float[np.ndarray, "T 3"]  # ECEF [m]
    velocity: Float[np.ndarray, "T 3"]  # ECEF [m/s]
    attitude: Float[np.ndarray, "T 3 3"]  # body to ECEF
    clock: Float[np.ndarray, "T 2"]  # offset [m] and drift [m/s] of the receiver's clock
    epochs: Int[np.ndarray, " E"]  # ticks
    sky: Sky
    error: Float[np.ndarray, "E S"]  # of the pseudoranges [m]


def recorded(
    name: str,
    time: Float[np.ndarray, " T"],
    inertial: Float[np.ndarray, "T 6"],
    epochs: Int[np.ndarray, " E"],
    sky: Sky,
    clock: Float[np.ndarray, "T 2"],
    error: Float[np.ndarray, "E S"],
    rate_error: Float[np.ndarray, "E S"],
) -> Log:
    """The log: `gyro` and `accelerometer` at each tick, at epochs `G01` and so on with pseudorange, Doppler and place.

    Args:
        name: of the log.
        time: of the ticks [s].
        inertial: angular rate [rad/s] and specific force [m/s²], forward, right, down.
        epochs: ticks of the sky.
        sky: S satellites at the epochs.
        clock: offset [m] and drift [m/s] of the receiver's.
        error: of the pseudoranges [m], NaN where a satellite was not received.
        rate_error: of the range rates [m/s].
    """
    received = np.isfinite(error)
    offset, drift = clock[epochs, :1], clock[epochs, 1:]
    doppler = -(sky.rate + drift + rate_error) * L1_HZ / LIGHT_M_S
    result = np.concatenate(
        [np.stack([sky.range + offset + error, doppler, sky.elevation], axis=2), sky.position, sky.velocity], axis=2
    )
    result = np.where(received[..., None], result, np.nan)
    width = len(sky.names) * len(_TOLD)
    value = np.full((len(time), len(INERTIAL) + width), np.nan)
    value[:, : len(INERTIAL)] = inertial
    value[epochs, len(INERTIAL) :] = result.reshape(len(epochs), width)
    tick_s, epoch_s = float(np.median(np.diff(time))), float(np.median(np.diff(time[epochs])))
    return Log(
        time=time,
        value=value,
        fresh=np.isfinite(value),
        channels=(*INERTIAL, *(Channel(what, one, unit, False) for one in sky.names for what, unit in _TOLD)),
        sensors=(
            Sensor("gyro", tick_s),
            Sensor("accelerometer", tick_s),
            *(Sensor(one, epoch_s) for one in sky.names),
        ),
        name=name,
    )
