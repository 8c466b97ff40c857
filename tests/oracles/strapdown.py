"""A strapdown mechanisation in an inertial frame, plain NumPy and SciPy: nothing of it turns with the earth."""

import numpy as np
from scipy.spatial.transform import Rotation

OMEGA = 7.2921151467e-5


def somigliana(place: np.ndarray) -> np.ndarray:
    """Gravity in ECEF from the closed form on the ellipsoid and the free-air gradient, plumb to the ellipsoid."""
    a, f = 6378137.0, 1 / 298.257223563
    e2 = f * (2 - f)
    p = np.hypot(place[0], place[1])
    lat = np.arctan2(place[2], p * (1 - e2))
    for _ in range(4):
        n = a / np.sqrt(1 - e2 * np.sin(lat) ** 2)
        lat = np.arctan2(place[2] + e2 * n * np.sin(lat), p)
    h, lon = p / np.cos(lat) - n, np.arctan2(place[1], place[0])
    s = np.sin(lat) ** 2
    g = 9.7803253359 * (1 + 0.00193185265241 * s) / np.sqrt(1 - e2 * s)
    g *= 1 - 2 / a * (1 + f + 0.00344978650684 - 2 * f * s) * h + 3 * h**2 / a**2
    return -g * np.array([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)])


def navigate(
    rate: np.ndarray, force: np.ndarray, dt: float, place: np.ndarray, velocity: np.ndarray, attitude: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """ECEF places, velocities and attitudes after each row, from those before the first.

    In an inertial frame that is the earth's at the start: gravitation is gravity less the centrifugal part.
    """
    spin, rows = np.array([0.0, 0.0, OMEGA]), np.arange(len(rate) + 1)
    steps, halves = (Rotation.from_rotvec(share * rate * dt).as_matrix() for share in (1.0, 0.5))
    now, middle = (Rotation.from_rotvec(spin * (rows + late)[:, None] * dt).as_matrix() for late in (0.0, 0.5))
    r, v, turned = place.copy(), velocity + np.cross(spin, place), attitude
    result = []
    for k in range(len(rate)):
        there = now[k].T @ r
        pull = somigliana(there) - OMEGA**2 * there * [1, 1, 0]
        v_new = v + (turned @ halves[k] @ force[k] + middle[k] @ pull) * dt
        r, v, turned = r + (v + v_new) / 2 * dt, v_new, turned @ steps[k]
        back = now[k + 1].T
        result.append((back @ r, back @ (v - np.cross(spin, r)), back @ turned))
    places, velocities, attitudes = (np.array(one) for one in zip(*result, strict=True))
    return places, velocities, attitudes
