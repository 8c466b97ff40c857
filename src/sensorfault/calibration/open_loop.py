"""Open-loop scores: a monitor with its limits off, replayed over healthy data."""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from sensorfault.core.monitor import Branch, Monitor, MonitorState
from sensorfault.core.stage import Stage
from sensorfault.core.types import Residual, Sample
from sensorfault.logs.table import Log
from sensorfault.runtime.replay import replay_log
from sensorfault.runtime.runners import replay, samples
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.statistic.norm import Norm
from sensorfault.stages.threshold.fixed import Fixed


def uncalibrated(monitor: Monitor) -> Monitor:
    """The monitor with all its limits off."""
    off = [Fixed(jnp.full(score.shape, jnp.inf)) for score in jax.eval_shape(_scores, monitor)]
    made: Monitor = eqx.tree_at(lambda m: [branch.threshold for branch in m.branches], monitor, off)
    return made


def _scores(monitor: Monitor) -> list[Float[Array, " K"]]:
    """The scores of an empty sample: the statistics alone, not the loop around them."""
    channels = len(monitor.owner)
    none = jnp.zeros(channels, bool)
    sample = Sample(jnp.zeros(()), jnp.zeros(channels), none, none, none)
    state = monitor.init()
    residual, _ = monitor.residual.evaluate(state.residual, sample)
    residual = residual._replace(out=none)
    pairs = zip(monitor.branches, state.branches, strict=True)
    return [branch.statistic.evaluate(memory, residual)[0].value for branch, (memory, _) in pairs]


def open_loop_scores(uncalibrated: Monitor, log: Log) -> tuple[Float[np.ndarray, "T K"], ...]:
    """The scores of every branch over a log; NaN where nothing was tested."""
    return tuple(np.asarray(score) for score in replay_log(uncalibrated, log).scores)


def extra_tape(residual: Stage[Any, Sample, Residual, Any], log: Log) -> Any:
    """`extra` of a residual generator for every sample of a healthy log; all samples are trusted."""
    channels = len(log.channels)
    silent = Branch(Norm(jnp.ones(channels)), Fixed(jnp.full(1, jnp.inf)))
    monitor = Monitor(residual, (silent,), Exceed(), Drop(), jnp.zeros(channels), tuple(range(channels)))
    rows = samples(log.time, log.value, log.fresh)
    return jax.tree.map(np.asarray, _extra(monitor, monitor.init(), rows))


@jax.jit
def _extra(monitor: Monitor, state: MonitorState, rows: Sample) -> Any:
    return replay(monitor, state, rows, lambda report: report.residual.extra)[1]
