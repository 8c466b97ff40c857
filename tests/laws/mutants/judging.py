"""Wrong statistics, thresholds and decisions."""

from typing import Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from laws.guests.learner import RunningSigma, Spread
from laws.guests.statistics import Normalized
from sensorfault.core.types import NEVER, Accusation, Evidence, Residual, Score, Trust
from sensorfault.stages.decision.exceed import Exceed


class Stateless(eqx.Module):
    def init(self) -> tuple[()]:
        return ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()


def judged(residual: Residual) -> Score:
    return Normalized().evaluate((), residual)[0]


class JudgesWhatIsNotThere(Stateless):
    """Tests every channel at every sample, measured or not."""

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        score = judged(residual)
        return score._replace(valid=jnp.ones_like(score.valid)), ()


class AllOrNothing(Stateless):
    """Tests no channel while one of them is missing."""

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        score = judged(residual)
        return score._replace(valid=score.valid & score.valid.all()), ()


class Ranked(Stateless):
    """Weighs a channel by its place in the log."""

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        score = judged(residual)
        return score._replace(value=score.value * jnp.arange(1.0, score.value.size + 1)), ()


class _Seen(NamedTuple):
    time: Float[Array, ""]
    broken: Bool[Array, ""]


class Offended(eqx.Module):
    """Says nothing any more once the clock had a gap."""

    def init(self) -> _Seen:
        return _Seen(jnp.asarray(NEVER, float), jnp.zeros((), bool))

    def evaluate(self, state: _Seen, residual: Residual) -> tuple[Score, _Seen]:
        broken = state.broken | ((residual.time - state.time > 10.0) & (state.time != NEVER))
        score = judged(residual)
        return score._replace(valid=score.valid & ~broken), _Seen(residual.time, broken)

    def update(self, pending: _Seen, trust: Trust) -> _Seen:
        return pending


class _Habit(NamedTuple):
    square: Float[Array, " C"]
    count: Float[Array, " C"]


class Habituated(eqx.Module):
    """Judges each score against all that it ever saw, faults as well: after a long one it is blind to the next."""

    channels: int = eqx.field(static=True)

    def init(self) -> _Habit:
        return _Habit(jnp.zeros(self.channels), jnp.zeros(self.channels))

    def evaluate(self, state: _Habit, residual: Residual) -> tuple[Score, _Habit]:
        score = judged(residual)
        usual = jnp.sqrt(jnp.maximum(state.square / jnp.maximum(state.count, 1.0), 1.0))
        square = jnp.where(score.valid, score.value**2, 0.0)
        after = _Habit(state.square + square, state.count + score.valid.astype(float))
        return score._replace(value=score.value / usual), after

    def update(self, pending: _Habit, trust: Trust) -> _Habit:
        return pending


class Gullible(eqx.Module):
    """A limit that learns from every sample, trusted or not."""

    inner: RunningSigma

    def init(self) -> Spread:
        return self.inner.init()

    def evaluate(self, state: Spread, seen: Any) -> Any:
        return self.inner.evaluate(state, seen)

    def update(self, pending: Any, trust: Trust) -> Spread:
        return self.inner.update(pending, trust._replace(learn=jnp.ones_like(trust.learn)))


class PlainNumber(Stateless):
    """A limit that is no array, so each number compiles anew."""

    limit: float

    def evaluate(self, state: tuple[()], seen: tuple[Residual, Score]) -> tuple[Float[Array, " K"], tuple[()]]:
        return jnp.full(seen[1].value.shape, self.limit), ()


class Capped(Stateless):
    """A decision that takes no limit for higher than this, nor for lower."""

    lowest: float = eqx.field(static=True)
    highest: float = eqx.field(static=True)

    def evaluate(self, state: tuple[()], evidence: Evidence) -> tuple[Accusation, tuple[()]]:
        limits = tuple(jnp.clip(limit, self.lowest, self.highest) for limit in evidence.limits)
        return Exceed().evaluate((), evidence._replace(limits=limits))


class BlamesTheNext(Stateless):
    """A decision that names the neighbour."""

    def evaluate(self, state: tuple[()], evidence: Evidence) -> tuple[Accusation, tuple[()]]:
        scores = tuple(score._replace(blame=jnp.roll(score.blame, 1, axis=1)) for score in evidence.scores)
        return Exceed().evaluate((), evidence._replace(scores=scores))
