"""Run many logs of one shape through one model at once."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float, Int8

from sensorfault.core.monitor import Monitor
from sensorfault.core.types import Report, Sample
from sensorfault.core.verdicts import FAULT
from sensorfault.logs.table import Log
from sensorfault.runtime.model import Model
from sensorfault.runtime.runners import fleet
from sensorfault.stages.threshold.fixed import Fixed

BATCH = 128  # logs at once: one compilation for any number of them


@dataclass(frozen=True)
class Result:
    """Output of a model for N logs: verdicts, score and limit of each sensor (NaN where it was not tested), residual
    and expected value [SI].
    """

    channel: Int8[np.ndarray, "N T C"]
    score: Float[np.ndarray, "N T C"]
    limit: Float[np.ndarray, " C"]
    residual: Float[np.ndarray, "N T C"]
    expected: Float[np.ndarray, "N T C"]

    @property
    def fault(self) -> Bool[np.ndarray, "N T C"]:
        """Which channels are FAULT at which sample."""
        return np.asarray(self.channel == FAULT)

    @property
    def tested(self) -> Bool[np.ndarray, "N T C"]:
        """Which channels could be tested at which sample."""
        return np.asarray(np.isfinite(self.score))


def watch(model: Model, logs: Sequence[Log]) -> Result:
    """Run each log from the initial state; all logs have the model's channels and the same length."""
    kept = []
    for start in range(0, len(logs), BATCH):
        some = [logs[min(i, len(logs) - 1)] for i in range(start, start + BATCH)]
        value, fresh, time = (np.stack([getattr(log, name) for log in some]) for name in ("value", "fresh", "time"))
        present = np.isfinite(value)
        rows = Sample(*(jnp.asarray(x) for x in (time, value, present, fresh & present, np.zeros_like(present))))
        kept.append([np.asarray(x) for x in _watch(model.monitor, rows)])
    parts = zip(*kept, strict=True)
    channel, scores, limits, residual, expected = (np.concatenate(part)[: len(logs)] for part in parts)
    score, limit = np.full(channel.shape, np.nan), np.full(channel.shape[2], np.nan)
    columns = _columns(model, scores.shape[2])
    score[:, :, columns], limit[columns] = scores, limits[0, -1]
    return Result(channel, score, limit, residual, expected)


@jax.jit
def _watch(monitor: Monitor, rows: Sample) -> tuple[Array, ...]:
    def keep(report: Report) -> tuple[Array, ...]:
        first, residual = report.scores[0], report.residual
        score = jnp.where(first.valid, first.value, jnp.nan)
        return report.verdict.channel, score, report.limits[0], residual.value, residual.expected

    many = rows.time.shape[0]
    states = jax.tree.map(lambda x: jnp.broadcast_to(x, (many, *jnp.shape(x))), monitor.init())
    return fleet(monitor, states, rows, keep)[1]


def _columns(model: Model, tests: int) -> list[int]:
    """The channel of each test of the first branch, which has one test for each sensor."""
    paths = [channel.path for channel in model.channels]
    return [paths.index(path) for _, path in model.tests[:tests] if path is not None]


def with_limits(model: Model, limit: Float[np.ndarray, " C"]) -> Model:
    """The model with these limits on the scores of its channels."""
    tests = jax.eval_shape(_limits, model.monitor).size
    own = Fixed(jnp.asarray(limit[_columns(model, tests)]))
    return replace(model, monitor=eqx.tree_at(lambda m: m.branches[0].threshold, model.monitor, own))


def _limits(monitor: Monitor) -> Float[Array, " K"]:
    """The limits for an empty sample, for their shape."""
    channels = len(monitor.owner)
    none = jnp.zeros(channels, bool)
    sample = Sample(jnp.zeros(()), jnp.zeros(channels), none, none, none)
    return monitor.step(monitor.init(), sample)[1].limits[0]
