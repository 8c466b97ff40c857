"""Pseudoranges corrected for satellite clock and atmosphere, and the positions of the satellites."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from sensorfault.logs.readers.gnss.broadcast import Broadcast
from sensorfault.logs.readers.gnss.observed import Observed
from sensorfault.numerics.geodesy import ecef_to_geodetic, enu_axes
from sensorfault.numerics.gnss import sight
from sensorfault.numerics.gnss.atmosphere import klobuchar, saastamoinen
from sensorfault.numerics.gnss.constants import L1_HZ, LIGHT_M_S, WEEK_S

_ROUNDS = 10
_EARTH_M = (6.3e6, 6.5e6)  # from the centre: where a receiver on or over the ground is
_UNWEIGHTED_M = 15.0  # a residual beyond this pulls no harder than this


def with_satellites(seen: Observed, broadcast: Broadcast) -> Observed:
    """The observations with, for each satellite that has ephemerides, its place, velocity, clock and a corrected range.

    The place is that of the time of transmission in the earth's frame of that time: the earth's turn meanwhile is left
    to `gnss.sight.distance`. `corrected_m` is the pseudorange without the satellite's clock, relativity, group delay,
    troposphere and, where its coefficients are known, ionosphere; the receiver's clock is in it.
    """
    pseudorange = seen.value["pseudorange_m"]
    shape = pseudorange.shape
    place, speed = np.full((*shape, 3), np.nan), np.full((*shape, 3), np.nan)
    clock = np.full(shape, np.nan)
    for i, name in enumerate(seen.satellites):
        sent = seen.time - pseudorange[:, i] / LIGHT_M_S
        there = np.flatnonzero(np.isfinite(sent))
        if name not in broadcast.satellites or not len(there):
            continue
        # its own clock says when it sent: t = t' - Δt(t')
        sent = sent[there] - broadcast.at(name, sent[there]).clock
        found = broadcast.at(name, np.where(np.isfinite(sent), sent, -np.inf))
        place[there, i], speed[there, i], clock[there, i] = found
    corrected = pseudorange + LIGHT_M_S * clock
    known = {
        **{f"{axis}_m": place[..., k] for k, axis in enumerate("xyz")},
        **{f"v{axis}_m_s": speed[..., k] for k, axis in enumerate("xyz")},
        "clock_s": clock,
    }
    receiver = _somewhere(corrected, place, seen.satellites)
    if receiver is not None:
        delay, elevation = _air(receiver, place, seen, broadcast)
        known |= {"corrected_m": corrected - delay, "elevation_rad": elevation}
    return replace(seen, value={**seen.value, **known})


def _air(
    receiver: Float[np.ndarray, "3"], place: Float[np.ndarray, "T S 3"], seen: Observed, broadcast: Broadcast
) -> tuple[Float[np.ndarray, "T S"], Float[np.ndarray, "T S"]]:
    """The delay by the air [m], and the elevation of the satellites [rad]."""
    latitude, longitude, height = (float(one) for one in ecef_to_geodetic(receiver))
    elevation, azimuth = sight.elevation_azimuth(receiver, place, enu_axes(latitude, longitude))
    delay = np.asarray(saastamoinen(latitude, height, elevation))
    if broadcast.klobuchar is not None:
        tow = (seen.time % WEEK_S)[:, None]
        frequency = np.array([seen.frequency.get(name[0], L1_HZ) for name in seen.satellites])
        delay = delay + klobuchar(broadcast.klobuchar, latitude, longitude, elevation, azimuth, tow, frequency)
    return delay, elevation


def _somewhere(
    corrected: Float[np.ndarray, "T S"], place: Float[np.ndarray, "T S 3"], satellites: tuple[str, ...]
) -> Float[np.ndarray, "3"] | None:
    """About where the receiver was in the epoch that has the most satellites; for the air 10 km are near enough.

    Least squares with a receiver clock for each system (Groves 2013, section 9.4.1), far residuals held back.
    """
    whole = np.isfinite(corrected) & np.isfinite(place).all(axis=2)
    epoch = int(whole.sum(axis=1).argmax())
    row = np.flatnonzero(whole[epoch])
    letters = [satellites[i][0] for i in row]
    system = np.array([[letter == one for one in sorted(set(letters))] for letter in letters], float)
    if not len(row) or len(row) < 3 + system.shape[1]:
        return None
    measured, at = corrected[epoch, row], place[epoch, row]
    state = np.zeros(3 + system.shape[1])
    for _ in range(_ROUNDS):
        distance = sight.distance(state[:3], at)
        residual = measured - distance - system @ state[3:]
        weight = 1 / np.maximum(np.abs(residual) / _UNWEIGHTED_M, 1.0) ** 0.5
        slope = np.column_stack(((state[:3] - at) / distance[:, None], system))
        state = state + np.linalg.lstsq(slope * weight[:, None], residual * weight, rcond=None)[0]
    found: Float[np.ndarray, 3] = state[:3]
    return found if _EARTH_M[0] < np.linalg.norm(found) < _EARTH_M[1] + 1e5 else None
