"""Satellites above a vehicle: their positions, and what a receiver without noise measures."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.numerics.geodesy import ecef_to_geodetic, enu_axes
from sensorfault.numerics.gnss import kepler, sight
from sensorfault.numerics.gnss.constants import LIGHT_M_S

_ROUNDS = 3  # of the time of flight: the last one moves a satellite by less than a nanometre
_HALF_S = 0.05  # of the interval over which a range's rate is taken
USED_ABOVE = float(np.deg2rad(10.0))


@dataclass(frozen=True)
class Sky:
    """S satellites at T epochs, seen from the vehicle, without noise and receiver clock."""

    names: tuple[str, ...]
    range: Float[np.ndarray, "T S"]  # path of the signal, with the rotation of the earth meanwhile [m]
    rate: Float[np.ndarray, "T S"]  # of that [m/s]
    position: Float[np.ndarray, "T S 3"]  # ECEF at transmission, in the frame of that time [m]
    velocity: Float[np.ndarray, "T S 3"]  # [m/s]
    elevation: Float[np.ndarray, "T S"]  # [rad]
    azimuth: Float[np.ndarray, "T S"]  # from north over east [rad]

    def only(self, kept: Bool[np.ndarray, " S"]) -> "Sky":
        """These satellites alone."""
        names = tuple(name for name, keep in zip(self.names, kept, strict=True) if keep)
        return Sky(
            names,
            self.range[:, kept],
            self.rate[:, kept],
            self.position[:, kept],
            self.velocity[:, kept],
            self.elevation[:, kept],
            self.azimuth[:, kept],
        )


def overhead(
    ephemeris: kepler.Ephemeris,
    time: Float[np.ndarray, " T"],
    position: Float[np.ndarray, "T 3"],
    velocity: Float[np.ndarray, "T 3"],
) -> Sky:
    """All satellites of a constellation, `G01` and on, those below the horizon too.

    Args:
        ephemeris: of S satellites.
        time: of arrival [s of GPS time].
        position: of the receiver, ECEF [m].
        velocity: ECEF [m/s].
    """
    way, sent = _way(ephemeris, time, position)
    before, after = (_way(ephemeris, time + h, position + h * velocity)[0] for h in (-_HALF_S, _HALF_S))
    there = kepler.position(ephemeris, sent)
    latitude, longitude, _ = ecef_to_geodetic(position)
    elevation, azimuth = sight.elevation_azimuth(position[:, None], there, enu_axes(latitude, longitude)[:, None])
    names = tuple(f"G{i + 1:02}" for i in range(there.shape[1]))
    rate = (after - before) / (2 * _HALF_S)
    return Sky(names, way, rate, there, kepler.velocity(ephemeris, sent), elevation, azimuth)


def _way(
    ephemeris: kepler.Ephemeris, time: Float[np.ndarray, " T"], position: Float[np.ndarray, "T 3"]
) -> tuple[Float[np.ndarray, "T S"], Float[np.ndarray, "T S"]]:
    """Length of the path [m] and time of transmission [s]: t = arrival - ρ(t) / c."""
    sent = time[:, None] - np.full(ephemeris.toe.shape, 0.075)
    for _ in range(_ROUNDS):
        way = np.asarray(sight.distance(position[:, None], kepler.position(ephemeris, sent)))
        sent = time[:, None] - way / LIGHT_M_S
    return way, sent
