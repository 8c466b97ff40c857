"""Training data of a predictor: the windows before each new measurement of a healthy log, as in live use."""

import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import Log
from sensorfault.training.inputs import Inputs
from sensorfault.training.windows import Windows


def prediction_windows(
    log: Log, inputs: Inputs, length: int, gap_s: float, stale_s: Float[np.ndarray, " D"]
) -> Windows:
    """The `length` rows before each tick with a new measurement of every output, and these measurements.

    Windows with a gap in the clock above `gap_s`, or with an output older than `stale_s`, are left out.
    """
    outputs = list(inputs.columns[: inputs.outputs])
    new = log.fresh[:, outputs] & np.isfinite(log.value[:, outputs])
    last = np.where(new, log.time[:, None], -np.inf)
    known = (log.time[:, None] - np.maximum.accumulate(last, axis=0) <= stale_s).all(axis=1)
    broken = ~known | (np.diff(log.time, prepend=-np.inf) > gap_s)
    # A row may open a window after a gap, not stand further on in it.
    bad = np.concatenate([[0], np.cumsum(broken)])
    unknown = np.concatenate([[0], np.cumsum(~known)])
    at = np.flatnonzero(new.all(axis=1))
    at = at[at >= length]
    first = at - length
    whole = (bad[at + 1] == bad[first + 1]) & (unknown[first + 1] == unknown[first])
    scaled = inputs.scaled
    return Windows(scaled, first[whole], scaled[at[whole], : inputs.outputs], length)
