"""What the raw measurements of satellites say together: place and velocity of the receiver, epoch by epoch."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.logs.epochs import ON_L1
from sensorfault.logs.satellites import satellites
from sensorfault.logs.table import Log, LogError
from sensorfault.numerics.geodesy import ecef_to_geodetic, enu_axes
from sensorfault.numerics.gnss import sight
from sensorfault.numerics.gnss.constants import L1_HZ, LIGHT_M_S

ROUNDS = 10
FAR_M, FAR_M_S = 5.0, 0.5  # a residual beyond this pulls less
LONE = 10.0  # the worst residual is out if it is so many times larger than the mean of the others
SPARE = 1  # satellites more than unknowns
FARTHEST_M = 1e8  # no satellite is so far away
EARTH_M = (6.3e6, 6.5e6)  # from the centre: where a receiver on or over the ground is


@dataclass(frozen=True)
class Solved:
    """n epochs: place (north, east of the first, height), velocity (north, east, up), and what each range is off.

    `off`: pseudorange minus what place and clock explain [m], NaN where none was received.
    """

    names: tuple[str, ...]
    time: Float[np.ndarray, " n"]
    degrees: Float[np.ndarray, "n 2"]  # latitude, longitude [rad]
    height: Float[np.ndarray, " n"]
    velocity: Float[np.ndarray, "n 3"]
    off: Float[np.ndarray, "n S"]


def solved(log: Log) -> Solved | None:
    """Least squares with a receiver clock for each system (Groves 2013, 9.4.1), far residuals held back.

    None if the log has no raw satellites with orbits, or too few of them.
    """
    try:
        seen = satellites(log, "GREC")
    except LogError:
        return None
    fresh = np.stack([log.fresh[:, log.index(f"{name}.corrected_m")] for name in seen.names], axis=1)
    usable = seen.usable & fresh & (np.abs(seen.corrected) < FARTHEST_M)
    systems = sorted({name[0] for name in seen.names})
    system = np.array([[name[0] == one for one in systems] for name in seen.names], float)
    clocks = (usable[:, :, None] * system).any(axis=1).sum(axis=1)
    rows = np.flatnonzero(usable.sum(axis=1) >= 3 + clocks + SPARE)
    if len(rows) < 5:
        return None
    there, measured = usable[rows], np.nan_to_num(seen.corrected[rows])
    at = np.where(there[..., None], seen.position[rows], EARTH_M[0] * 4)  # of an absent one somewhere
    state = np.zeros((len(rows), 3 + len(systems)))
    for _ in range(ROUNDS):
        far = sight.distance(state[:, None, :3], at)
        off = measured - far - state[:, 3:] @ system.T
        ahead = np.concatenate(
            [(state[:, None, :3] - at) / far[..., None], np.broadcast_to(system, (*there.shape, len(systems)))], axis=2
        )
        state += _least_squares(ahead, np.where(there, off, 0.0), there, FAR_M)
    radius = np.linalg.norm(state[:, :3], axis=1)
    good = (radius > EARTH_M[0]) & (radius < EARTH_M[1] + 1e5)
    if good.sum() < 5:
        return None
    rates = _rates(seen.doppler[rows], seen.velocity[rows], there, -ahead[..., :3], [n[0] in ON_L1 for n in seen.names])
    latitude, longitude, height = (np.asarray(one) for one in ecef_to_geodetic(state[:, :3]))
    axes = enu_axes(float(np.median(latitude[good])), float(np.median(longitude[good])))
    east, north, up = (rates @ axes.T).T
    off = np.where(there, off, np.nan)
    return Solved(
        seen.names,
        log.time[rows][good],
        np.stack([latitude, longitude], axis=1)[good],
        height[good],
        np.stack([north, east, up], axis=1)[good],
        off[good],
    )


def _least_squares(
    ahead: Float[np.ndarray, "n S p"], off: Float[np.ndarray, "n S"], there: Bool[np.ndarray, "n S"], far: float
) -> Float[np.ndarray, "n p"]:
    """One step for all epochs; a residual beyond `far` pulls with the root of its weight, and one that stands alone not
    at all. An absent clock stays 0.
    """
    size = np.where(there, np.abs(off), 0.0)
    worst = size.max(axis=1, keepdims=True)
    others = (size.sum(axis=1, keepdims=True) - worst) / np.maximum(there.sum(axis=1, keepdims=True) - 1, 1)
    lone = (size == worst) & (worst > LONE * np.maximum(others, far))
    weight = (there & ~lone) / np.maximum(size / far, 1.0)
    a = ahead * weight[..., None]
    normal = np.einsum("nsp,nsq->npq", a, ahead)
    absent = np.einsum("npp->np", normal) == 0
    normal += absent[..., None] * np.eye(ahead.shape[2])
    return np.asarray(np.linalg.solve(normal, np.einsum("nsp,ns->np", a, off)[..., None])[..., 0])


def _rates(
    doppler: Float[np.ndarray, "n S"],
    satellite: Float[np.ndarray, "n S 3"],
    there: Bool[np.ndarray, "n S"],
    to: Float[np.ndarray, "n S 3"],
    on_l1: list[bool],
) -> Float[np.ndarray, "n 3"]:
    """The receiver's velocity in ECEF [m/s]; NaN where too few Dopplers on L1 are there."""
    # range rate = -λ f = u (vs - vr) + c δ
    rate = -doppler * LIGHT_M_S / L1_HZ
    known = there & np.isfinite(rate) & np.isfinite(satellite).all(axis=2) & np.array(on_l1)
    off = np.where(known, np.nan_to_num(rate) - np.nan_to_num((to * satellite).sum(axis=2)), 0.0)
    ahead = np.concatenate([-to, np.ones((*known.shape, 1))], axis=2)
    state = np.zeros((len(off), 4))
    for _ in range(ROUNDS):
        state += _least_squares(
            ahead, np.where(known, off - np.einsum("nsp,np->ns", ahead, state), 0.0), known, FAR_M_S
        )
    return np.where(known.sum(axis=1, keepdims=True) >= 4 + SPARE, state[:, :3], np.nan)
