"""Which channels a multivariate method can watch, and why it cannot watch the others."""

import numpy as np
from jaxtyping import Bool

from sensorfault.logs.pauses import GAP
from sensorfault.logs.table import Log, LogError

_SLOWER = 1.5  # a channel with more than so many ticks between two measurements is slower than the clock


def channels_to_watch(name: str, log: Log) -> None:
    """Whether there are any, as a recipe's `needs`.

    Raises:
        LogError: no channel is left to watch.
    """
    watchable(log)


def watchable(log: Log, often: float = 0.5) -> tuple[Bool[np.ndarray, " C"], dict[str, str]]:
    """Channels that change and have a value in at least the share `often` of the ticks; path -> reason for the others.

    Where no channel is there so often, ticks in its dropouts do not count: it is silent at times, but not slow.

    Raises:
        LogError: no channel is left to watch.
    """
    marked = np.array([channel.watch for channel in log.channels], bool)
    fast = log.measured >= often
    if not (fast & marked).any():
        fast = np.array([_share_outside_dropouts(column) >= often for column in log.arrived.T], bool)
    watched = np.zeros(len(log.channels), bool)
    reasons: dict[str, str] = {}
    for i, channel in enumerate(log.channels):
        if not channel.watch:
            reasons[channel.path] = "marked watch = false"
        elif not fast[i]:
            reasons[channel.path] = _too_seldom(log.arrived[:, i])
        elif not log.changes[i]:
            reasons[channel.path] = "constant in the training data"
        else:
            watched[i] = True
    if not watched.any():
        why = "; ".join(f"{path}: {reason}" for path, reason in reasons.items())
        raise LogError(f"{log.name} has no channel to watch ({why}); set watch = true for one that changes.")
    return watched, reasons


def _too_seldom(measured: Bool[np.ndarray, " T"]) -> str:
    if not measured.any():
        return "no value in the training data"
    if _usual_step(measured) > _SLOWER:
        return "slower than the clock"
    return f"a value in only {measured.mean():.0%} of the rows"


def _usual_step(measured: Bool[np.ndarray, " T"]) -> float:
    """Ticks from one value to the next."""
    at = np.flatnonzero(measured)
    return float(np.median(np.diff(at))) if len(at) > 1 else float(len(measured))


def _share_outside_dropouts(measured: Bool[np.ndarray, " T"]) -> float:
    """Share of the ticks with a value, without those in a time of more than GAP usual steps without one."""
    at = np.flatnonzero(measured)
    without = np.diff(np.concatenate([[-1], at, [len(measured)]])) - 1
    alive = len(measured) - without[without >= GAP * _usual_step(measured)].sum()
    return len(at) / float(alive) if alive > 0 else 0.0
