"""Initial premises of fuzzy rules: how the space of scaled features is divided before training."""

from collections.abc import Iterator
from itertools import product

import numpy as np
from jaxtyping import Float

from sensorfault.numerics.fuzzy import Premises

SLOPE = 2.0
# Width at which a membership of each kind is one half where a Gaussian with sigma 1 is one half.
HALF = {"bell": np.sqrt(2 * np.log(2)), "gaussian": 1.0, "triangle": 2 * np.sqrt(2 * np.log(2))}
SQUASH, ACCEPT, REJECT = 1.5, 0.5, 0.15  # Chiu 1994
CHUNK = 256  # rows whose distances to all others are in memory at a time


def grid(inputs: int, memberships: int, kind: str = "bell") -> Premises:
    """Evenly spaced memberships on each input, neighbours crossing at one half, and a rule for every combination."""
    apart = 1 / max(memberships - 1, 1)
    center = np.tile(np.linspace(0, 1, memberships) if memberships > 1 else 0.5, inputs)
    of = tuple(i for i in range(inputs) for _ in range(memberships))
    rules = tuple(product(*(range(i * memberships, (i + 1) * memberships) for i in range(inputs))))
    return _premises(center, np.full(center.shape, apart / 2 / HALF["bell"]), of, rules, kind)


def scatter(x: Float[np.ndarray, "N F"], rules: int, seed: int = 0, kind: str = "bell") -> Premises:
    """A rule at each of `rules` random rows, as wide as if they divided the space evenly. Jang 1993."""
    drawn = np.random.default_rng(seed).choice(len(x), min(rules, len(x)), replace=False)
    wide = 0.5 * len(drawn) ** (-1 / x.shape[1])
    return _around(x[drawn], np.full(x.shape[1], wide / HALF["bell"]), kind)


def subtractive(
    x: Float[np.ndarray, "N F"], target: Float[np.ndarray, " N"], radius: float = 0.5, kind: str = "bell"
) -> Premises:
    """A rule at each center of a subtractive clustering of the rows with their targets. Chiu 1994.

    `radius`: reach of a cluster, as a share of the range of each input and of the target.
    """
    spread = np.ptp(target)
    joint = np.column_stack([x, (target - target.min()) / (spread if spread > 0 else 1.0)])
    chosen = list(_centers(joint, radius))
    # σ = radius / √8
    return _around(x[chosen], np.full(x.shape[1], radius / np.sqrt(8)), kind)


def _centers(joint: Float[np.ndarray, "N D"], radius: float) -> Iterator[int]:
    """Rows of the highest potential, one after the other; each reduces the potential of its neighbours."""

    def near(rows: Float[np.ndarray, "n D"], reach: float) -> Float[np.ndarray, "n N"]:
        square = ((rows[:, None] - joint[None]) ** 2).sum(axis=2)
        return np.asarray(np.exp(-4 * square / reach**2))

    # P_i = Σ exp(-4 |x_i - x_j|² / ra²)
    potential = np.concatenate([near(joint[k : k + CHUNK], radius).sum(axis=1) for k in range(0, len(joint), CHUNK)])
    first, found = potential.max(), list[int]()
    while (highest := potential.max()) > REJECT * first:
        at = int(potential.argmax())
        away = min((np.linalg.norm(joint[at] - joint[k]) for k in found), default=np.inf)
        # Between accept and reject a center must be far enough from the others for its potential.
        if highest <= ACCEPT * first and away / radius + highest / first < 1:
            potential[at] = 0.0
            continue
        found.append(at)
        yield at
        # P_i ← P_i - P* exp(-4 |x_i - x*|² / rb²)
        potential = potential - highest * near(joint[at][None], SQUASH * radius)[0]


def _around(center: Float[np.ndarray, "R F"], sigma: Float[np.ndarray, " F"], kind: str) -> Premises:
    """A rule at each center, with its own memberships."""
    rules, inputs = center.shape
    of = tuple(range(inputs)) * rules
    own = tuple(tuple(range(r * inputs, (r + 1) * inputs)) for r in range(rules))
    return _premises(center.reshape(-1), np.tile(sigma, rules), of, own, kind)


def _premises(
    center: Float[np.ndarray, " P"],
    sigma: Float[np.ndarray, " P"],
    inputs: tuple[int, ...],
    rules: tuple[tuple[int, ...], ...],
    kind: str,
) -> Premises:
    return Premises(center, sigma * HALF[kind], np.full(center.shape, SLOPE), inputs, rules, kind)
