"""What the methods of this family need of a log. Each raises LogError if the log lacks it; nothing is fitted."""

from dataclasses import replace
from typing import Any
from weakref import ref

import numpy as np
from jaxtyping import Bool

from sensorfault.logs.rates import complete
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.common.rows import LEAST_ROWS, Training
from sensorfault.training.blocks import blocks_of
from sensorfault.training.unbroken import LAGS, unbroken

_last: list[Any] = []  # the log by a weak reference, its complete rows, and which channels change
OFTEN = 0.9  # share of the ticks with a value; a channel that is often late breaks the runs of consecutive rows


def in_a_row(name: str, log: Log) -> Training:
    """The training data for conditioning: channels with a value in nearly every tick, rows that follow LAGS others.

    A channel that changes in one block of the log only is not watched: of the others nothing can be learned of it.

    Raises:
        LogError: no channel to watch, or too few such rows.
    """
    training = _lasting(Training.of(name, log, OFTEN))
    rows = int(unbroken(log.time, training.rows, LAGS).sum())
    if rows < LEAST_ROWS:
        raise LogError(
            f"{log.name} has {rows} rows that follow {LAGS} complete ones without a gap, {name} needs {LEAST_ROWS}; "
            "give it more data, or watch fewer channels."
        )
    return training


def _lasting(training: Training) -> Training:
    """The training data without channels that are constant outside one block.

    Raises:
        LogError: no channel is left.
    """
    log, watched = training.log, training.watched & _changing(training)
    brief = [
        channel.path for channel, was, now in zip(log.channels, training.watched, watched, strict=True) if was > now
    ]
    if not brief:
        return training
    if not watched.any():
        raise LogError(f"{log.name} has no channel that changes in more than one stretch of it; give it more data.")
    reasons = training.reasons | dict.fromkeys(brief, "changes in one stretch of the training data only")
    return replace(training, watched=watched, rows=complete(log, watched), reasons=reasons)


def _changing(training: Training) -> Bool[np.ndarray, " C"]:
    """Channels that change outside each block. Several methods ask the same of one log: the last answer is kept."""
    log = training.log
    if _last and _last[0]() is log and np.array_equal(_last[1], training.rows):
        return np.asarray(_last[2])
    parts = [log.value[block][training.rows[block]] for block in blocks_of(len(log))]
    parts = [part for part in parts if len(part)]
    least, most = (np.array([extreme(part, axis=0) for part in parts]) for extreme in (np.min, np.max))
    found = np.ones(len(log.channels), bool)
    for i in range(len(parts) if len(parts) > 1 else 0):
        found &= np.delete(most, i, 0).max(axis=0) > np.delete(least, i, 0).min(axis=0)
    _last[:] = [ref(log), training.rows, found]
    return found
