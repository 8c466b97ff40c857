"""A score against its recent size, so that a rough road is no fault and a smooth one hides none."""

from typing import Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Float

from sensorfault.core.stage import Stage
from sensorfault.core.types import Residual, Score, Trust


class _Lately(NamedTuple):
    inner: Any
    square: Float[Array, " K"]


class _Work(NamedTuple):
    inner: Any
    square: Float[Array, " K"]
    score: Score


class Relative(eqx.Module):
    """score / rms of the score over about `memory` healthy samples, each test by itself.

    The rms is a reference, so it learns from trusted samples only, and it stays within `lowest` and `highest`, which
    healthy data had: beyond, the test is as one without it. While nothing may be learned it relaxes towards `highest`,
    so that a sudden roughness does not alarm for ever.
    """

    statistic: Stage[Any, Residual, Score, Any]
    memory: Float[Array, ""]
    lowest: Float[Array, " K"]
    highest: Float[Array, " K"]

    def init(self) -> _Lately:
        return _Lately(self.statistic.init(), self.highest**2)

    def evaluate(self, state: _Lately, residual: Residual) -> tuple[Score, _Work]:
        score, inner = self.statistic.evaluate(state.inner, residual)
        rms = jnp.sqrt(jnp.clip(state.square, self.lowest**2, self.highest**2))
        return score._replace(value=score.value / rms), _Work(inner, state.square, score)

    def update(self, work: _Work, trust: Trust) -> _Lately:
        score = work.score
        learn = score.valid & ~(score.covers & ~trust.learn[None]).any(axis=1)
        seen = jnp.where(learn, score.value, self.highest) ** 2
        # s² ← s² + (score² - s²) / memory
        square = jnp.where(score.valid, work.square + (seen - work.square) / self.memory, work.square)
        return _Lately(self.statistic.update(work.inner, trust), square)
