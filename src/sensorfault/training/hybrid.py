"""Jang's hybrid training: what rules say by least squares, forward; when they apply by gradient, backward."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from sensorfault.numerics.fuzzy import FAINT, Premises
from sensorfault.training.consequents import Lesson, Solved, missed, rms, solve

NARROW, STEEP = 0.02, (0.5, 8.0)  # bounds of a and b
GROW, SHRINK, RUN = 1.1, 0.9, 4  # Jang 1993, section III


class Slope(NamedTuple):
    """Of the mean square error over each premise's parameters."""

    center: Float[np.ndarray, " P"]
    width: Float[np.ndarray, " P"]
    slope: Float[np.ndarray, " P"]


def slope(premises: Premises, lesson: Lesson, solved: Solved) -> Slope:
    """∂E/∂(c, a, b), E the mean square error; the consequents stay, which at their best changes nothing."""
    f = solved.left + lesson.y
    # ∂E/∂ln w_r = 2 e w_r (f_r - f) / N
    fired = 2 / len(f) * (solved.left[:, None] * solved.weights * (solved.says - f[:, None]))
    grade = fired @ premises.asked()
    t = (lesson.x[:, premises.inputs] - premises.center) / premises.width
    by_t, by_b = STEEPNESS[premises.kind](t, premises.slope, solved.grades)
    along = grade * by_t
    # ∂t/∂c = -1/a,  ∂t/∂a = -t/a
    center, width = (-(along * x).sum(axis=0) / premises.width for x in (np.ones_like(t), t))
    return Slope(center, width, (grade * by_b).sum(axis=0))


_Grades = Float[np.ndarray, "N P"]


def _bell(t: _Grades, b: Float[np.ndarray, " P"], grades: _Grades) -> tuple[_Grades, _Grades]:
    # u = b ln t²,  ln μ = -ln(1 + e^u),  ∂ln μ/∂u = μ - 1
    square = np.maximum(t * t, FAINT)
    by_u = np.expm1(grades)
    return by_u * 2 * b * t / square, by_u * np.log(square)


def _gaussian(t: _Grades, b: Float[np.ndarray, " P"], grades: _Grades) -> tuple[_Grades, _Grades]:
    return -t, np.zeros_like(t)


def _triangle(t: _Grades, b: Float[np.ndarray, " P"], grades: _Grades) -> tuple[_Grades, _Grades]:
    inside = np.maximum(1 - np.abs(t), FAINT)
    return -np.sign(t) * np.where(np.abs(t) < 1, 1 / inside, 1.0), np.zeros_like(t)


# ∂ln μ/∂t and ∂ln μ/∂b of each kind of membership.
STEEPNESS: dict[str, Callable[[_Grades, Float[np.ndarray, " P"], _Grades], tuple[_Grades, _Grades]]] = {
    "bell": _bell,
    "gaussian": _gaussian,
    "triangle": _triangle,
}


def stepped(premises: Premises, down: Slope, size: float) -> Premises:
    """A step of this length against the slope, kept within bounds. Jang 1993, equation (11)."""
    norm = np.sqrt(sum((part**2).sum() for part in down))
    if not norm > 0:
        return premises
    center, width, b = (
        getattr(premises, name) - size / norm * part for name, part in zip(Slope._fields, down, strict=True)
    )
    return replace(premises, center=center, width=np.maximum(width, NARROW), slope=np.clip(b, *STEEP))


@dataclass
class StepRule:
    """Jang's: after four decreases in a row 10 % longer, after two times up and down 10 % shorter."""

    size: float
    grown: int = 0
    shrunk: int = 0

    def hear(self, errors: Sequence[float]) -> None:
        """All errors so far, the newest last."""
        now = len(errors)
        change = np.sign(np.diff(errors[-RUN - 1 :]))
        if len(change) < RUN:
            return
        if (change < 0).all() and now - self.grown >= RUN:
            self.size, self.grown = self.size * GROW, now
        if (change == [1, -1, 1, -1]).all() and now - self.shrunk >= RUN:
            self.size, self.shrunk = self.size * SHRINK, now


class Course(NamedTuple):
    """The best epoch's premises and what they say; errors by epoch."""

    premises: Premises
    consequents: Float[np.ndarray, "R F+1"]
    learned: tuple[float, ...]
    validated: tuple[float, ...]
    best_epoch: int


def hybrid(premises: Premises, lesson: Lesson, unseen: Lesson | None, epochs: int, step: float) -> Course:
    """So many epochs; the best is that of the least error on `unseen`, or without it on the lesson."""
    rule = StepRule(step)
    learned, validated = list[float](), list[float]()
    best = premises, np.zeros(0), 0
    for epoch in range(epochs + 1):
        solved = solve(premises, lesson)
        learned.append(rms(solved.left))
        if unseen is not None:
            validated.append(missed(premises, solved.consequents, unseen))
        judged = validated or learned
        if judged[-1] <= min(judged):
            best = premises, solved.consequents, epoch
        rule.hear(learned)
        premises = stepped(premises, slope(premises, lesson, solved), rule.size)
    return Course(best[0], best[1], tuple(learned), tuple(validated), best[2])
