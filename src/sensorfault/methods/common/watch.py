"""Which channels a multivariate method can watch, and why it cannot watch the others."""

import numpy as np
from jaxtyping import Bool

from sensorfault.logs.table import Log, LogError


def channels_to_watch(name: str, log: Log) -> None:
    """Whether there are any, as a recipe's `needs`.

    Raises:
        LogError: no channel is left to watch.
    """
    watchable(log)


def watchable(log: Log, often: float = 0.5) -> tuple[Bool[np.ndarray, " C"], dict[str, str]]:
    """Channels that change and have a value in at least the share `often` of the ticks; path -> reason for the others.

    Raises:
        LogError: no channel is left to watch.
    """
    measured = log.fresh & np.isfinite(log.value)
    fast = measured.mean(axis=0) >= often
    watched = np.zeros(len(log.channels), bool)
    reasons: dict[str, str] = {}
    for i, channel in enumerate(log.channels):
        if not channel.watch:
            reasons[channel.path] = "marked watch = false"
        elif not fast[i]:
            reasons[channel.path] = "slower than the clock"
        elif np.ptp(log.value[measured[:, i], i]) == 0:
            reasons[channel.path] = "constant in the training data"
        else:
            watched[i] = True
    if not watched.any():
        why = "; ".join(f"{path}: {reason}" for path, reason in reasons.items())
        raise LogError(f"{log.name} has no channel to watch ({why}); set watch = true for one that changes.")
    return watched, reasons
