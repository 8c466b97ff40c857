"""Premises by a population search instead of a gradient: slower, but not caught in the nearest local minimum."""

import numpy as np
from jaxtyping import Float

from sensorfault.training.consequents import Lesson, Numbers, solve
from sensorfault.training.hybrid import STEEP, Course

BOUNDS = ((-0.25, 1.25), (0.05, 2.0), STEEP)  # of c, a and b, in units of the training range
SIZE = 5  # individuals for each number to optimise


def population(numbers: Numbers, lesson: Lesson, unseen: Lesson | None, generations: int, seed: int) -> Course:
    """Differential evolution (Storn & Price 1997) of centers, widths and slopes, the consequents by least squares.

    Minimises the error on `unseen`, or without it on the lesson. `numbers` is one of the first generation.
    """
    from scipy.optimize import Bounds, differential_evolution  # lazily: slow to import, and seldom needed

    low, high = (np.repeat([bound[i] for bound in BOUNDS], numbers.center.size) for i in range(2))

    def error(sought: Float[np.ndarray, " n"]) -> float:
        own = Numbers(*sought.reshape(3, -1))
        solved = solve(own, lesson)
        return solved.error if unseen is None else solve(own, unseen, solved.consequents).error

    best = list[float]()
    found = differential_evolution(
        error,
        Bounds(low, high),
        maxiter=generations,
        popsize=SIZE,
        rng=seed,
        polish=False,
        x0=np.clip(np.concatenate(numbers), low, high),
        callback=lambda intermediate_result: best.append(float(intermediate_result.fun)),
    )
    own = Numbers(*found.x.reshape(3, -1))
    solved = solve(own, lesson)
    learned, validated = (tuple(best), ()) if unseen is None else ((solved.error,), tuple(best))
    return Course(own, solved.consequents, learned, validated, len(best))
