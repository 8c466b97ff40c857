"""Learning curve: how good a model is that is trained on part of the labelled rows, tested on other rows."""

from collections.abc import Callable, Sequence
from typing import TypeVar

import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import LogError
from sensorfault.training.labelled import Labelled

SIZES = (25, 50, 100, 200, 400)

Answer = Callable[[Float[np.ndarray, "M F"]], Float[np.ndarray, " M"]]
Result = TypeVar("Result")


def learning_curve(
    fit: Callable[[Labelled], Answer],
    judge: Callable[[Float[np.ndarray, " M"], Float[np.ndarray, " M"]], Result],
    learn: Labelled,
    test: Labelled,
    sizes: Sequence[int] = SIZES,
    draws: int = 5,
    seed: int = 0,
) -> list[tuple[int, Result]]:
    """Each size in rising order, with judge(answers, targets) on the test rows for a model trained on so many rows.

    Rows are drawn at random, and a larger draw contains the smaller ones, so a curve shows what more rows add. A draw
    that cannot be trained on (for example no anomaly among 25 rows) has no result.

    Raises:
        LogError: fewer rows than the largest size.
    """
    rows = len(learn.target)
    if max(sizes) > rows:
        raise LogError(f"{rows} labelled rows are fewer than {max(sizes)}; give more rows, or smaller sizes.")
    result = list[tuple[int, Result]]()
    for d in range(draws):
        order = np.random.default_rng((seed, d)).permutation(rows)
        for size in sizes:
            part = order[:size]
            try:
                answer = fit(Labelled(learn.features[part], learn.target[part]))
            except LogError:
                continue
            result.append((size, judge(answer(test.features), test.target)))
    return sorted(result, key=lambda one: one[0])
