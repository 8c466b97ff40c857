"""Tapes: what healthy data make of a monitor whose limits are off."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import Log
from sensorfault.monitor.monitor import Monitor
from sensorfault.monitor.threshold.fixed import Fixed
from sensorfault.replay import replay_log
from sensorfault.types import Sample


def deaf(monitor: Monitor) -> Monitor:
    """The monitor with all its limits off."""
    channels = len(monitor.owner)
    none = jnp.zeros(channels, bool)
    sample = Sample(jnp.zeros(()), jnp.zeros(channels), none, none, none)
    told = jax.eval_shape(lambda: monitor.step(monitor.init(), sample)[1])
    off = [Fixed(jnp.full(score.value.shape, jnp.inf)) for score in told.scores]
    monitor = eqx.tree_at(lambda m: [branch.threshold for branch in m.branches], monitor, off)
    return monitor


def score_tape(deaf: Monitor, log: Log) -> tuple[Float[np.ndarray, "T K"], ...]:
    """The scores of every branch over a log, NaN where a test had nothing to test."""
    return tuple(np.asarray(score) for score in replay_log(deaf, log).scores)
