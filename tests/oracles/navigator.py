"""A tightly coupled GNSS/INS filter in plain NumPy: derivatives by differences, one joint update, errors truth less
estimate (the package's: estimate less truth).

Mechanisation of oracles/strapdown.py, in an inertial frame; the way of a signal by its time of flight.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial.transform import Rotation

from oracles.strapdown import OMEGA, navigate, somigliana

LIGHT, L1 = 299792458.0, 1575.42e6
SPIN = np.array([0.0, 0.0, OMEGA])
STEPS = np.repeat([1e-4, 1.0, 50.0, 1e-4, 1e-2, 10.0, 1.0], [3, 3, 3, 3, 3, 1, 1])  # of the differences
# of the package's errors: what is wrong with the instruments has the sign of a bias in both
SIGN = np.repeat([-1.0, 1.0, -1.0], [9, 6, 2])


@dataclass(frozen=True)
class State:
    attitude: np.ndarray
    velocity: np.ndarray
    place: np.ndarray
    gyro: np.ndarray  # bias
    force: np.ndarray  # bias
    clock: float
    drift: float

    def moved(self, by: np.ndarray) -> "State":
        return State(
            Rotation.from_rotvec(by[:3]).as_matrix() @ self.attitude,
            *(
                old + by[i : i + 3]
                for old, i in ((self.velocity, 3), (self.place, 6), (self.gyro, 9), (self.force, 12))
            ),
            self.clock + by[15],
            self.drift + by[16],
        )


def derivative(of, at: State) -> np.ndarray:
    """Columns: how a function of the state, told what it was moved by, changes with each error."""
    columns = [
        (of(at.moved(e * h), e * h) - of(at.moved(-e * h), -e * h)) / (2 * h)
        for e, h in zip(np.eye(17), STEPS, strict=True)
    ]
    return np.stack(columns, axis=1)


def growth(at: State, gyro: np.ndarray, force: np.ndarray) -> np.ndarray:
    """F of ẋ = F x, for what the instruments say."""

    def turning(x: State) -> np.ndarray:
        return x.attitude @ (gyro - x.gyro) - SPIN

    def rates(x: State, by: np.ndarray) -> np.ndarray:
        # that of an error between two attitudes, the first of which turns on as well
        turn = turning(x) - Rotation.from_rotvec(by[:3]).as_matrix() @ turning(at)
        pull = x.attitude @ (force - x.force) + somigliana(x.place) - 2 * np.cross(SPIN, x.velocity)
        return np.concatenate([turn, pull, x.velocity, np.zeros(6), [x.drift, 0.0]])

    return derivative(rates, at)


def way(receiver: np.ndarray, satellites: np.ndarray) -> np.ndarray:
    """How far the signals came, in an inertial frame that is the earth's on their arrival."""
    x, y, z = satellites.T
    flight = np.full(len(x), 0.07)
    for _ in range(4):
        c, s = np.cos(OMEGA * flight), np.sin(OMEGA * flight)
        flight = np.linalg.norm(np.stack([c * x + s * y, c * y - s * x, z], axis=1) - receiver, axis=1) / LIGHT
    return flight * LIGHT


def expected(x: State, places: np.ndarray, speeds: np.ndarray, rates: bool) -> np.ndarray:
    """Pseudoranges, and Dopplers behind them."""
    ranges = way(x.place, places) + x.clock
    if not rates:
        return ranges
    late, early = (way(x.place + h * x.velocity, places + h * speeds) for h in (0.05, -0.05))
    return np.concatenate([ranges, -((late - early) / 0.1 + x.drift) * L1 / LIGHT])


def ahead(x: State) -> np.ndarray:
    """Speed forward, to the right and down."""
    return x.attitude.T @ x.velocity


@dataclass(frozen=True)
class Navigator:
    state: State
    cov: np.ndarray

    def carried(self, gyro: np.ndarray, force: np.ndarray, dt: float, density: np.ndarray) -> "Navigator":
        """After rows of a stretch; `density` of what each error gains in variance in a second."""
        x = self.state
        start = x.place, x.velocity, x.attitude
        places, velocities, attitudes = navigate(gyro - x.gyro, force - x.force, dt, *start)
        way = np.concatenate([x.attitude[None], attitudes])
        f = np.zeros((17, 17))
        for row in range(len(gyro)):
            at = replace(x, attitude=(way[row] + way[row + 1]) / 2, place=places[row], velocity=velocities[row])
            f += growth(at, gyro[row], force[row]) * dt
        long = len(gyro) * dt
        end = replace(
            x,
            attitude=attitudes[-1],
            velocity=velocities[-1],
            place=places[-1],
            clock=x.clock + x.drift * long,
        )
        # first order, as the package's: Φ = I + ∫ F dt
        phi = np.eye(17) + f
        return Navigator(end, phi @ self.cov @ phi.T + np.diag(density * long))

    def result(self, z: np.ndarray, h: np.ndarray, r: np.ndarray) -> "Navigator":
        """All measurements at once."""
        s = h @ self.cov @ h.T + np.diag(r)
        gain = np.linalg.solve(s, h @ self.cov).T
        keep = np.eye(17) - gain @ h
        cov = keep @ self.cov @ keep.T + gain @ np.diag(r) @ gain.T
        return Navigator(self.state.moved(gain @ z), cov)
