"""Jang's hybrid training of fuzzy rules: consequents by least squares (forward), premises by gradient (backward)."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from sensorfault.numerics.fuzzy import FAINT
from sensorfault.training.consequents import Lesson, Numbers, Solved, solve

NARROW, STEEP = 0.02, (0.5, 8.0)  # bounds of a and b
GROW, SHRINK, RUN = 1.1, 0.9, 4  # Jang 1993, section III


def slope(numbers: Numbers, lesson: Lesson, solved: Solved) -> Numbers:
    """∂E/∂(c, a, b), E the mean square error, with fixed consequents: at their optimum their change does not matter."""
    e, t = solved.left, solved.t
    # ∂E/∂ln w_r = 2 e w_r (f_r - f) / N
    fired = 2 / len(e) * e[:, None] * solved.weights * (solved.says - (e + lesson.y)[:, None])
    grade = fired @ lesson.asked
    by_t, by_b = STEEPNESS[lesson.kind](t, numbers.slope, solved.grades)
    along = grade * by_t
    # ∂t/∂c = -1/a,  ∂t/∂a = -t/a
    return Numbers(
        center=-along.sum(axis=0) / numbers.width,
        width=-(along * t).sum(axis=0) / numbers.width,
        slope=(grade * by_b).sum(axis=0),
    )


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


def stepped(numbers: Numbers, down: Numbers, size: float) -> Numbers:
    """A step of this length against the gradient, kept within bounds. Jang 1993, equation (11)."""
    norm = np.sqrt(sum((part**2).sum() for part in down))
    if not norm > 0:
        return numbers
    center, width, b = (now - size / norm * part for now, part in zip(numbers, down, strict=True))
    return Numbers(center, np.maximum(width, NARROW), np.clip(b, *STEEP))


@dataclass
class StepRule:
    """Jang's step size rule: 10 % longer after four decreases in a row, 10 % shorter after two ups and downs."""

    size: float
    grown: int = 0
    shrunk: int = 0

    def adapt(self, errors: Sequence[float]) -> None:
        """Adapt the step to all errors so far, the newest last."""
        now = len(errors)
        change = np.sign(np.diff(errors[-RUN - 1 :]))
        if len(change) < RUN:
            return
        if (change < 0).all() and now - self.grown >= RUN:
            self.size, self.grown = self.size * GROW, now
        if (change == [1, -1, 1, -1]).all() and now - self.shrunk >= RUN:
            self.size, self.shrunk = self.size * SHRINK, now


class Course(NamedTuple):
    """The best premises and their consequents; errors by epoch."""

    numbers: Numbers
    consequents: Float[np.ndarray, "R D"]
    learned: tuple[float, ...]
    validated: tuple[float, ...]
    best_epoch: int


def hybrid(numbers: Numbers, lesson: Lesson, unseen: Lesson | None, epochs: int, step: float) -> Course:
    """Train for `epochs`; the best epoch has the smallest error on `unseen`, or without it on the lesson."""
    rule = StepRule(step)
    learned, validated = list[float](), list[float]()
    best, says, least = 0, np.zeros(0), np.inf
    found = numbers
    for epoch in range(epochs + 1):
        solved = solve(numbers, lesson)
        learned.append(solved.error)
        if unseen is not None:
            validated.append(solve(numbers, unseen, solved.consequents).error)
        error = validated[-1] if validated else learned[-1]
        if error < least:
            best, found, says, least = epoch, numbers, solved.consequents, error
        rule.adapt(learned)
        numbers = stepped(numbers, slope(numbers, lesson, solved), rule.size)
    return Course(found, says, tuple(learned), tuple(validated), best)
