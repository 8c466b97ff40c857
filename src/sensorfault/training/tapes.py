"""Tapes: what healthy data make of a monitor whose limits are off."""

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Float

from sensorfault.logs.table import Log
from sensorfault.monitor.monitor import Monitor
from sensorfault.monitor.threshold.fixed import Fixed
from sensorfault.replay import replay_log
from sensorfault.types import Sample


def deaf(monitor: Monitor) -> Monitor:
    """The monitor with all its limits off."""
    off = [Fixed(jnp.full(shape.shape, jnp.inf)) for shape in jax.eval_shape(_scores, monitor)]
    made: Monitor = eqx.tree_at(lambda m: [branch.threshold for branch in m.branches], monitor, off)
    return made


def _scores(monitor: Monitor) -> list[Float[Array, " K"]]:
    """The scores of an empty sample."""
    channels = len(monitor.owner)
    none = jnp.zeros(channels, bool)
    sample = Sample(jnp.zeros(()), jnp.zeros(channels), none, none, none)
    return [score.value for score in monitor.step(monitor.init(), sample)[1].scores]


def score_tape(deaf: Monitor, log: Log) -> tuple[Float[np.ndarray, "T K"], ...]:
    """The scores of every branch over a log, NaN where a test had nothing to test."""
    return tuple(np.asarray(score) for score in replay_log(deaf, log).scores)
