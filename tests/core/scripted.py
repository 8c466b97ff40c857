"""Stages that say what the log tells them to: residuals and scores come as the sample's block."""

from typing import Any, NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from laws import walk as laws_walk
from laws.walk import Walk
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.types import Residual, Sample, Score, Trust
from sensorfault.runtime.runners import samples
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.threshold.fixed import Fixed


class Said(NamedTuple):
    """The scores of each branch, and what was expected."""

    scores: tuple[Float[Array, " K"], ...]
    expected: Float[Array, " C"]


class FromBlock(eqx.Module):
    """Expected value from the block; the state is the last value taken in, measured or stand-in."""

    channels: int = eqx.field(static=True)

    def init(self) -> Float[Array, " C"]:
        return jnp.zeros(self.channels)

    def evaluate(self, state: Float[Array, " C"], sample: Sample) -> tuple[Residual, Float[Array, " C"]]:
        expected = sample.block.expected
        residual = Residual(
            time=sample.time,
            value=sample.value - expected,
            cov=jnp.eye(self.channels),
            measured=sample.value,
            expected=expected,
            noise=jnp.ones(self.channels),
            valid=sample.fresh,
            born=sample.born,
            extra=sample.block.scores,
        )
        return residual, state

    def update(self, state: Float[Array, " C"], trust: Trust) -> Float[Array, " C"]:
        return jnp.where(trust.measured | trust.filled, trust.value, state)


class Says(eqx.Module):
    """The scores of one branch, as the block gives them; a test needs a valid channel among those it covers."""

    covers: Bool[Array, "K C"]
    blame: Float[Array, "K C"]
    branch: int = eqx.field(static=True, default=0)

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], residual: Residual) -> tuple[Score, tuple[()]]:
        covers = self.covers & residual.valid[None, :]
        blame = jnp.where(covers, self.blame, 0.0)
        return Score(residual.extra[self.branch], covers.any(axis=1), covers, blame), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()


def each(channels: int, branch: int = 0) -> Says:
    """One test a channel."""
    return Says(jnp.eye(channels, dtype=bool), jnp.eye(channels), branch)


def says(
    branches: list[Branch], owner: tuple[int, ...], *, most=0, hold_s=0.0, decision=None, recovery=None
) -> Monitor:
    hold = jnp.full(len(owner), hold_s, float)
    return Monitor(FromBlock(len(owner)), tuple(branches), decision or Exceed(), recovery or Drop(), hold, owner, most)


def branch(statistic: Any, limit: float = 1.0, gates: bool = True) -> Branch:
    return Branch(statistic, Fixed(jnp.full(statistic.blame.shape[0], limit, float)), gates)


def script(scores, value=None, *, fresh=True, expected=0.0, time=None) -> Sample:
    """Rows (T, K) of scores, one array a branch, as samples; value (T, C) is 1 everywhere unless given."""
    scores = tuple(np.asarray(one, float) for one in (scores if isinstance(scores, tuple) else (scores,)))
    rows = len(scores[0])
    value = np.ones((rows, scores[0].shape[1])) if value is None else np.asarray(value, float)
    fresh = np.broadcast_to(np.asarray(fresh), value.shape)
    time = np.arange(rows, dtype=float) if time is None else np.asarray(time, float)
    return samples(time, value, fresh, Said(scores, np.broadcast_to(np.asarray(expected, float), value.shape)))


LONGEST = 12  # rows; one length for all scripts means one compilation for all scripts of a monitor


def walk(monitor: Monitor, rows: Sample) -> Walk:
    """All steps of a script, its end filled up with rows that are cut off again."""
    length = len(rows.time)
    filled = jax.tree.map(lambda x: np.concatenate([x, np.repeat(np.asarray(x)[-1:], LONGEST - length, axis=0)]), rows)
    return jax.tree.map(lambda x: x[:length], laws_walk.walk(monitor, filled))
