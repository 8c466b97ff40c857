"""Premises by a population instead of a gradient: slower, and not bound to the hollow it starts in."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from sensorfault.numerics.fuzzy import Premises
from sensorfault.training.consequents import Lesson, missed, rms, solve
from sensorfault.training.hybrid import STEEP, Course

BOUNDS = ((-0.25, 1.25), (0.05, 2.0), STEEP)  # of c, a and b, in units of the training range
SIZE = 5  # individuals for each number sought


def population(premises: Premises, lesson: Lesson, unseen: Lesson | None, generations: int, seed: int) -> Course:
    """Differential evolution (Storn & Price 1997) of centers, widths and slopes, the consequents by least squares.

    What is minimised is the error on `unseen`, or without it on the lesson. One of the first generation is as given.
    """
    from scipy.optimize import Bounds, differential_evolution  # lazily: slow to import, and seldom needed

    count = premises.center.size
    low, high = (np.repeat([bound[i] for bound in BOUNDS], count) for i in range(2))

    def of(numbers: Float[np.ndarray, " n"]) -> Premises:
        center, width, slope = numbers.reshape(3, count)
        return replace(premises, center=center, width=width, slope=slope)

    def error(numbers: Float[np.ndarray, " n"]) -> float:
        own = of(numbers)
        solved = solve(own, lesson)
        return rms(solved.left) if unseen is None else missed(own, solved.consequents, unseen)

    best = list[float]()
    found = differential_evolution(
        error,
        Bounds(low, high),
        maxiter=generations,
        popsize=SIZE,
        rng=seed,
        polish=False,
        x0=np.clip(np.concatenate([premises.center, premises.width, premises.slope]), low, high),
        callback=lambda intermediate_result: best.append(float(intermediate_result.fun)),
    )
    premises = of(found.x)
    solved = solve(premises, lesson)
    errors = (rms(solved.left),) if unseen is not None else tuple(best)
    return Course(premises, solved.consequents, errors, tuple(best) if unseen is not None else (), len(best))
