"""The GNSS/INS filter written in plain NumPy, for bench_navigation.py: the same arithmetic, with loops in Python."""

from typing import Any

import numpy as np

from sensorfault.methods.gnss.gnss_ins import GRADE, SIGMA
from sensorfault.numerics.geodesy import ECCENTRICITY_SQUARED, SEMI_MAJOR_AXIS
from sensorfault.numerics.gnss.constants import EARTH_RATE_RAD_S, LIGHT_M_S
from sensorfault.numerics.gnss.sight import distance, turned
from sensorfault.numerics.gravity import gravity

MOST, LEAST, PARTS, DOUBT = 3, 4, 2, 1.5
EYE = np.eye(3)


def skew(a: np.ndarray) -> np.ndarray:
    x, y, z = a.tolist()
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


EARTH = skew(np.array([0.0, 0.0, EARTH_RATE_RAD_S]))
DENSITY = np.repeat(
    [
        float(x) ** 2
        for x in (GRADE.gyro, GRADE.force, 0.0, GRADE.gyro_walk, GRADE.force_walk, GRADE.clock, GRADE.drift)
    ],
    [3, 3, 3, 3, 3, 1, 1],
)


def rotation(angle: np.ndarray) -> np.ndarray:
    s, t2 = skew(angle), float(angle @ angle)
    return EYE + (1 - t2 / 6 + t2**2 / 120) * s + (0.5 - t2 / 24 + t2**2 / 720) * (s @ s)


def stretch(nav: Any, own: Any, gyro: Any, force: Any, dt: Any) -> tuple[Any, np.ndarray, float]:
    """Navigation after some rows, the transition matrix over them, and their duration."""
    c, v, r = nav
    pull = gravity(r)
    way_f, way_c, long = np.zeros(3), np.zeros((3, 3)), 0.0
    for w, f, h in zip(gyro - own[0], force - own[1], dt.tolist(), strict=True):
        after = c @ rotation(w * h) - EARTH @ c * h
        middle = (after + c) / 2
        felt = middle @ f
        faster = v + (felt + pull - 2 * (EARTH @ v)) * h
        r = r + (v + faster) / 2 * h
        c, v = after, faster
        way_f, way_c, long = way_f + felt * h, way_c + middle * h, long + h
    away = np.sqrt(r @ r)
    z = r[2] / away
    surface = SEMI_MAJOR_AXIS * np.sqrt(1 - ECCENTRICITY_SQUARED * (2 - ECCENTRICITY_SQUARED) * z**2)
    phi = np.eye(17)
    phi[0:3, 0:3] -= EARTH * long
    phi[0:3, 9:12] = phi[3:6, 12:15] = way_c
    phi[3:6, 0:3] = -skew(way_f)
    phi[3:6, 3:6] -= 2 * EARTH * long
    phi[3:6, 6:9] = -2 * long * np.outer(gravity(r), r / away) / surface
    phi[6:9, 3:6] = EYE * long
    phi[15, 16] = long
    return (c, v, r), phi, long


def lines(r: np.ndarray, place: np.ndarray, clock: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Expected pseudoranges, their rows of H, and their variances."""
    long = distance(r[None], place)
    sight = turned(place, long / LIGHT_M_S) - r
    sight = sight / np.sqrt((sight**2).sum(axis=1))[:, None]
    up = r / np.array([1.0, 1.0, 1 - ECCENTRICITY_SQUARED])
    elevation = np.arcsin(sight @ (up / np.sqrt(up @ up)))
    h = np.zeros((len(place), 17))
    h[:, 6:9], h[:, 15] = sight, -1.0
    zenith, horizon, scale = SIGMA
    return long + clock, h, (zenith + horizon * np.exp(-np.maximum(elevation, 0) / scale)) ** 2


def left_out(z: np.ndarray, cov: np.ndarray, limit: float) -> np.ndarray:
    """Satellites excluded for too large innovations, largest first; and those not used although not excluded."""
    size = np.abs(z) / np.sqrt(np.diag(cov))
    out = np.zeros(len(z), bool)
    for _ in range(MOST):
        over = (size > limit) & ~out
        if not over.any() or (~out).sum() <= LEAST:
            break
        out[np.argmax(np.where(over, size, -np.inf))] = True
    return out


def navigate(belief: Any, block: Any, value: np.ndarray, limit: float) -> tuple[np.ndarray, np.ndarray]:
    """Innovations (E, S) [m] of all epochs from this state on, and the excluded satellites."""
    nav, p = tuple(belief.nav), belief.cov
    own = [belief.own.gyro, belief.own.force, float(belief.own.clock), float(belief.own.drift)]
    per = -(-block.dt.shape[1] // PARTS)
    result, flagged, refused = [], [], bool(belief.refused)
    for k in range(len(value)):
        gyro, force, dt = block.gyro[k], block.force[k], block.dt[k]
        p = p * (DOUBT**2 if refused else 1.0)
        for part in (slice(0, per), slice(per, None)):
            there = dt[part] > 0
            nav, phi, long = stretch(nav, own, gyro[part][there], force[part][there], dt[part][there])
            p = phi @ p @ phi.T + np.diag(DENSITY * long)
        p = (p + p.T) / 2
        own[2] += own[3] * dt.sum()
        expected, h, r = lines(nav[2], block.place[k], own[2])
        z = value[k] - expected
        out = left_out(z, h @ p @ h.T + np.diag(r), limit)
        result.append(z)
        flagged.append(out)
        still_over = np.abs(z) / np.sqrt(np.diag(h @ p @ h.T) + r) > limit
        taken = ~out & ~still_over
        x = np.zeros(17)
        for i in np.flatnonzero(taken):
            ph = p @ h[i]
            s = ph @ h[i] + r[i]
            gain = ph / s
            x = x + gain * (z[i] - h[i] @ x)
            p = p - np.outer(gain, ph) - np.outer(ph, gain) + s * np.outer(gain, gain)
        p = (p + p.T) / 2
        c = rotation(-x[:3]) @ nav[0]
        nav = (1.5 * c - 0.5 * (c @ (c.T @ c)), nav[1] - x[3:6], nav[2] - x[6:9])
        own = [own[0] + x[9:12], own[1] + x[12:15], own[2] - x[15], own[3] - x[16]]
        refused = 2 * taken.sum() < len(taken)
    return np.array(result), np.array(flagged)
