"""How much there must be to learn from: what is learned from parts of the labelled rows, judged on others."""

from collections.abc import Callable, Sequence

import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import LogError

SIZES = (25, 50, 100, 200, 400)

Labelled = tuple[Float[np.ndarray, "N F"], Float[np.ndarray, " N"]]
Answer = Callable[[Float[np.ndarray, "M F"]], Float[np.ndarray, " M"]]


def learning_curve(
    fit: Callable[[Labelled], Answer],
    judge: Callable[[Float[np.ndarray, " M"], Float[np.ndarray, " M"]], float],
    learn: Labelled,
    test: Labelled,
    sizes: Sequence[int] = SIZES,
    draws: int = 5,
    seed: int = 0,
) -> Float[np.ndarray, "sizes draws"]:
    """judge(answers, targets) on the test rows, of what is learned from so many of the rows, drawn by chance.

    NaN where the draw could not be learned from (no anomaly among 25 rows, say). The draws of one size are nested in
    those of the next, so that a curve shows what more rows add.

    Raises:
        LogError: fewer rows than the largest size.
    """
    features, target = learn
    if max(sizes) > len(target):
        raise LogError(f"{len(target)} labelled rows are fewer than {max(sizes)}; give more, or learn from fewer.")
    told = np.full((len(sizes), draws), np.nan)
    for d in range(draws):
        order = np.random.default_rng((seed, d)).permutation(len(target))
        for s, size in enumerate(sizes):
            part = order[:size]
            try:
                answer = fit((features[part], target[part]))
            except LogError:
                continue
            told[s, d] = judge(answer(test[0]), test[1])
    return told
