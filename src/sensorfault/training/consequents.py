"""What fuzzy rules with given premises say best: their consequents by least squares."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from sensorfault.numerics.fuzzy import Premises, strengths
from sensorfault.training.elm import ridge

RIDGE = 1e-6  # of a row's weight: two features may be one, and few rows may call for a rule


class Lesson(NamedTuple):
    """Scaled features and what is to be said of them."""

    x: Float[np.ndarray, "N F"]
    y: Float[np.ndarray, " N"]


class Solved(NamedTuple):
    """The best that rules with given premises can say, and what that leaves of the lesson."""

    grades: Float[np.ndarray, "N P"]
    weights: Float[np.ndarray, "N R"]
    says: Float[np.ndarray, "N R"]
    left: Float[np.ndarray, " N"]
    consequents: Float[np.ndarray, "R F+1"]


def rms(left: Float[np.ndarray, " N"]) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(left**2)))


def solve(premises: Premises, lesson: Lesson) -> Solved:
    """Consequents by ridge regression, layers 1 to 5. Xu et al. 2023, equations (21)-(25)."""
    rows, inputs = lesson.x.shape
    grades, weights = _fired(premises, lesson.x)
    one = np.column_stack([lesson.x, np.ones(rows)])
    design = (weights[:, :, None] * one[:, None]).reshape(rows, -1)
    consequents = ridge(design, lesson.y[:, None], 1 / (RIDGE * rows)).reshape(-1, inputs + 1)
    says = one @ consequents.T
    return Solved(grades, weights, says, (weights * says).sum(axis=1) - lesson.y, consequents)


def missed(premises: Premises, consequents: Float[np.ndarray, "R F+1"], lesson: Lesson) -> float:
    """Root mean square error on rows that the consequents were not solved on."""
    _, weights = _fired(premises, lesson.x)
    says = lesson.x @ consequents[:, :-1].T + consequents[:, -1]
    return rms((weights * says).sum(axis=1) - lesson.y)


def _fired(
    premises: Premises, x: Float[np.ndarray, "N F"]
) -> tuple[Float[np.ndarray, "N P"], Float[np.ndarray, "N R"]]:
    grades = premises.grades(x)
    return grades, strengths(grades @ premises.asked().T)
