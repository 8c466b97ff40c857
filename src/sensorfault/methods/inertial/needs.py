"""What the methods of this family need of a log. Each raises LogError if the log lacks it; nothing is fitted."""

from dataclasses import replace

import numpy as np

from sensorfault.logs.rates import complete
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.common.rows import LEAST_ROWS, Training
from sensorfault.training.blocks import blocks_of
from sensorfault.training.unbroken import LAGS, unbroken

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
    log, watched = training.log, training.watched.copy()
    for block in blocks_of(len(log)):
        others = training.rows.copy()
        others[block] = False
        if others.any():
            watched &= np.ptp(log.value[others], axis=0) > 0
    brief = [
        channel.path for channel, was, now in zip(log.channels, training.watched, watched, strict=True) if was > now
    ]
    if not brief:
        return training
    if not watched.any():
        raise LogError(f"{log.name} has no channel that changes in more than one stretch of it; give it more data.")
    reasons = training.reasons | dict.fromkeys(brief, "changes in one stretch of the training data only")
    return replace(training, watched=watched, rows=complete(log, watched), reasons=reasons)
