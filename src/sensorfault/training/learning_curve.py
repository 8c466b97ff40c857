"""How much there must be to learn from: what is learned from parts of the labelled rows, judged on others."""

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
    """Each size, the least first, and judge(answers, targets) on the test rows of what so many rows teach.

    Rows are drawn by chance, those of one size among those of the next, so that a curve shows what more rows add.
    Nothing is told where a draw cannot be learned from (no anomaly among 25 rows, say).

    Raises:
        LogError: fewer rows than the largest size.
    """
    rows = len(learn.target)
    if max(sizes) > rows:
        raise LogError(f"{rows} labelled rows are fewer than {max(sizes)}; give more, or learn from fewer.")
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
