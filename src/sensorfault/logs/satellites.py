"""The satellites of a log as arrays for navigation: one slot per satellite, NaN while it is not received."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.logs.table import Log, LogError

_PLACE = ("x_m", "y_m", "z_m")
_VELOCITY = ("vx_m_s", "vy_m_s", "vz_m_s")


@dataclass(frozen=True)
class Satellites:
    """T ticks of S satellites, NaN where there is nothing.

    `position` is of the time of transmission in the earth's frame of that time: `gnss.sight.distance` adds the turn of
    the earth. `corrected` has no satellite clock and no delay by the air in it, only the receiver's clock and noise.
    """

    names: tuple[str, ...]
    corrected: Float[np.ndarray, "T S"]  # pseudorange [m]
    doppler: Float[np.ndarray, "T S"]  # [Hz]
    cn0: Float[np.ndarray, "T S"]  # [dB-Hz]
    elevation: Float[np.ndarray, "T S"]  # [rad]
    position: Float[np.ndarray, "T S 3"]  # ECEF [m]
    velocity: Float[np.ndarray, "T S 3"]  # [m/s]

    @property
    def usable(self) -> Bool[np.ndarray, "T S"]:
        """Where a corrected pseudorange and a place are known."""
        usable: Bool[np.ndarray, "T S"] = np.isfinite(self.corrected) & np.isfinite(self.position).all(axis=2)
        return usable

    @property
    def born(self) -> Bool[np.ndarray, "T S"]:
        """Ticks at which a satellite becomes usable."""
        usable = self.usable
        born = usable.copy()
        born[1:] &= ~usable[:-1]
        return born


def satellites(log: Log, systems: str = "GRECJ") -> Satellites:
    """The satellites of a log that have a corrected pseudorange and a place, by name.

    Args:
        log: as read from raw measurements with ephemerides (UBX, RINEX beside its navigation files, libRSF).
        systems: letters of those that are wanted: G GPS, R GLONASS, E Galileo, C BeiDou, J QZSS.

    Raises:
        LogError: there are none.
    """
    at = {channel.path: i for i, channel in enumerate(log.channels)}
    names = tuple(
        sensor.name
        for sensor in log.sensors
        if sensor.name[:1] in systems and all(f"{sensor.name}.{one}" in at for one in ("corrected_m", *_PLACE))
    )
    if not names:
        raise LogError(
            f"{log.name}: no raw satellite data with orbits of {systems}; read a log of raw "
            "measurements and put its navigation file beside it."
        )

    def values(channel: str) -> Float[np.ndarray, "T S"]:
        missing = np.full(len(log), np.nan)
        columns = [at.get(f"{name}.{channel}") for name in names]
        return np.stack([missing if i is None else log.value[:, i] for i in columns], axis=1)

    return Satellites(
        names,
        values("corrected_m"),
        values("doppler_hz"),
        values("cn0_dbhz"),
        values("elevation_rad"),
        np.stack([values(one) for one in _PLACE], axis=2),
        np.stack([values(one) for one in _VELOCITY], axis=2),
    )
