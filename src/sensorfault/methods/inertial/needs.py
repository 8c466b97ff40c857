"""What the methods of this family need of a log. Each raises LogError if the log lacks it; nothing is fitted."""

from sensorfault.logs.table import Log, LogError
from sensorfault.methods.common.rows import LEAST_ROWS, Training
from sensorfault.training.unbroken import LAGS, unbroken

OFTEN = 0.9  # share of the ticks with a value; a channel that is often late breaks the runs of consecutive rows


def in_a_row(name: str, log: Log) -> Training:
    """The training data for conditioning: channels with a value in nearly every tick, rows that follow LAGS others.

    Raises:
        LogError: no channel to watch, or too few such rows.
    """
    training = Training.of(name, log, OFTEN)
    rows = int(unbroken(log.time, training.rows, LAGS).sum())
    if rows < LEAST_ROWS:
        raise LogError(
            f"{log.name} has {rows} rows that follow {LAGS} complete ones without a gap, {name} needs {LEAST_ROWS}; "
            "give it more data, or watch fewer channels."
        )
    return training
