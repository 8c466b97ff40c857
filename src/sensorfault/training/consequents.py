"""The consequents of fuzzy rules with given premises, by least squares."""

from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from sensorfault.numerics.fuzzy import MEMBERSHIPS, Premises, strengths
from sensorfault.training.elm import ridge

RIDGE = 1e-6  # two features may be equal, and a rule may apply to few rows


class Numbers(NamedTuple):
    """The trained numbers of premises, or the gradient of the error. A tuple, because equinox would be slow here."""

    center: Float[np.ndarray, " P"]
    width: Float[np.ndarray, " P"]
    slope: Float[np.ndarray, " P"]

    @classmethod
    def of(cls, premises: Premises) -> "Numbers":
        return cls(premises.center, premises.width, premises.slope)


class Lesson(NamedTuple):
    """Training data: `one`, scaled features and a column of ones; `seen`, the input of each membership; `y`, targets.

    `asked`, `kind`: as in Premises. `ridge`: penalty on the consequents for each row.
    """

    one: Float[np.ndarray, "N D"]
    seen: Float[np.ndarray, "N P"]
    y: Float[np.ndarray, " N"]
    asked: Float[np.ndarray, "R P"]
    kind: str
    ridge: float

    @classmethod
    def of(
        cls, premises: Premises, x: Float[np.ndarray, "N F"], y: Float[np.ndarray, " N"], ridge: float = RIDGE
    ) -> "Lesson":
        """For rules with the inputs and memberships of these premises."""
        one = np.column_stack([x, np.ones(len(x))])
        return cls(one, x[:, premises.inputs], y, premises.asked(), premises.kind, ridge)


class Solved(NamedTuple):
    """The best consequents, the output of each rule (`says`) and the error (`left`); t = (x - c) / a."""

    t: Float[np.ndarray, "N P"]
    grades: Float[np.ndarray, "N P"]
    weights: Float[np.ndarray, "N R"]
    says: Float[np.ndarray, "N R"]
    left: Float[np.ndarray, " N"]
    consequents: Float[np.ndarray, "R D"]

    @property
    def error(self) -> float:
        """RMS of `left`."""
        return float(np.sqrt(np.mean(self.left**2)))


def solve(numbers: Numbers, lesson: Lesson, consequents: Float[np.ndarray, "R D"] | None = None) -> Solved:
    """Layers 1 to 5; consequents by ridge regression if none are given. Xu et al. 2023, (21)-(25)."""
    t = (lesson.seen - numbers.center) / numbers.width
    grades = MEMBERSHIPS[lesson.kind](t, numbers.slope)
    weights = strengths(grades @ lesson.asked.T)
    rows, columns = lesson.one.shape
    if consequents is None:
        design = (weights[:, :, None] * lesson.one[:, None]).reshape(rows, -1)
        consequents = ridge(design, lesson.y[:, None], 1 / (lesson.ridge * rows)).reshape(-1, columns)
    says = lesson.one @ consequents.T
    return Solved(t, grades, weights, says, (weights * says).sum(axis=1) - lesson.y, consequents)
