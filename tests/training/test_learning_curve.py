"""Parts that are drawn: how many, which, and what happens where nothing can be learned."""

import numpy as np
import pytest

from sensorfault.logs.table import LogError
from sensorfault.training.labelled import Labelled
from sensorfault.training.learning_curve import learning_curve


def test_each_size_is_learned_from_that_many_rows() -> None:
    learn, test = Labelled(np.arange(60.0)[:, None], np.arange(60.0)), Labelled(np.zeros((3, 1)), np.ones(3))
    seen: list[np.ndarray] = []

    def fit(part):
        seen.append(part.target)
        if len(part.target) == 20 and len(seen) < 3:
            raise LogError("too few.")
        np.testing.assert_array_equal(part.features[:, 0], part.target)
        return lambda features: np.full(len(features), float(len(part.target)))

    result = learning_curve(fit, lambda answer, target: float(answer[0] + target[0]), learn, test, (20, 40), draws=3)
    assert result == [(20, 21.0)] * 2 + [(40, 41.0)] * 3
    assert all(len(set(part)) == len(part) for part in seen)
    assert all(set(small) < set(large) for small, large in zip(seen[::2], seen[1::2], strict=True))
    assert set(seen[0]) != set(seen[2])


def test_too_few_rows_are_said_so() -> None:
    with pytest.raises(LogError, match="60 labelled rows"):
        learning_curve(lambda part: None, lambda a, t: 0.0, *[Labelled(np.zeros((60, 1)), np.zeros(60))] * 2)
