"""Tapes: what healthy data make of a monitor whose limits are off."""

import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import Log
from sensorfault.monitor.monitor import Monitor
from sensorfault.replay import replay_log


def score_tape(deaf: Monitor, log: Log) -> tuple[Float[np.ndarray, "T K"], ...]:
    """The scores of every branch over a log, NaN where a test had nothing to test."""
    return tuple(np.asarray(score) for score in replay_log(deaf, log).scores)
