"""What fuzzy rules with given premises say best: their consequents by least squares."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from sensorfault.numerics.fuzzy import MEMBERSHIPS, Premises, strengths
from sensorfault.training.elm import ridge

RIDGE = 1e-6  # two features may be one, and few rows may call for a rule


class Numbers(NamedTuple):
    """What is trained of premises, or the slope of the error over it. A tuple: equinox would take most of the time."""

    center: Float[np.ndarray, " P"]
    width: Float[np.ndarray, " P"]
    slope: Float[np.ndarray, " P"]

    @classmethod
    def of(cls, premises: Premises) -> "Numbers":
        return cls(premises.center, premises.width, premises.slope)


class Lesson(NamedTuple):
    """Scaled features, with 1 behind them and as each membership sees them, and what is to be said of them.

    `asked`, `kind`: as in Premises. `ridge`: penalty on the consequents for each row.
    """

    one: Float[np.ndarray, "N F+1"]
    seen: Float[np.ndarray, "N P"]
    y: Float[np.ndarray, " N"]
    asked: Float[np.ndarray, "R P"]
    kind: str
    ridge: float

    @classmethod
    def of(
        cls, premises: Premises, x: Float[np.ndarray, "N F"], y: Float[np.ndarray, " N"], ridge: float = RIDGE
    ) -> "Lesson":
        """For rules that look at x as these premises do."""
        one = np.column_stack([x, np.ones(len(x))])
        return cls(one, x[:, premises.inputs], y, premises.asked(), premises.kind, ridge)


class Solved(NamedTuple):
    """The best that rules can say, and what that leaves of the lesson; t = (x - c) / a."""

    t: Float[np.ndarray, "N P"]
    grades: Float[np.ndarray, "N P"]
    weights: Float[np.ndarray, "N R"]
    says: Float[np.ndarray, "N R"]
    left: Float[np.ndarray, " N"]
    consequents: Float[np.ndarray, "R F+1"]

    @property
    def error(self) -> float:
        """Root mean square."""
        return float(np.sqrt(np.mean(self.left**2)))


def solve(numbers: Numbers, lesson: Lesson, consequents: Float[np.ndarray, "R F+1"] | None = None) -> Solved:
    """Layers 1 to 5, the consequents by ridge regression where none are given. Xu et al. 2023, (21)-(25)."""
    t = (lesson.seen - numbers.center) / numbers.width
    grades = MEMBERSHIPS[lesson.kind](t, numbers.slope)
    weights = strengths(grades @ lesson.asked.T)
    rows, columns = lesson.one.shape
    if consequents is None:
        design = (weights[:, :, None] * lesson.one[:, None]).reshape(rows, -1)
        consequents = ridge(design, lesson.y[:, None], 1 / (lesson.ridge * rows)).reshape(-1, columns)
    says = lesson.one @ consequents.T
    return Solved(t, grades, weights, says, (weights * says).sum(axis=1) - lesson.y, consequents)
