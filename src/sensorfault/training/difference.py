"""The difference of two heights on a healthy flight: the lag of one behind the other, and its spread."""

from dataclasses import replace

import jax.numpy as jnp
import numpy as np

from sensorfault.calibration.open_loop import extra_tape
from sensorfault.logs.table import Log, LogError
from sensorfault.stages.residual.difference import Difference

APART = 10  # changes are taken over so many beats, so that slow changes of the offset do not count as lag
LONGEST_S = 3.0  # no barometer or receiver has a larger lag [s]
LEAST_BEATS = 60
FINEST_M = 0.01


def fit_difference(part: Difference, log: Log, lagging: bool = True) -> Difference:
    """Fit the lag that makes the difference smallest while the reference moves, and the variance around the mean.

    `lagging` False: no lag.

    Raises:
        LogError: too few beats with both sensors.
    """
    beat = extra_tape(part, log)
    d, speed = beat.difference[beat.closed], beat.speed[beat.closed]
    if len(d) < LEAST_BEATS:
        raise LogError(
            f"{log.name} has {len(d)} beats of {float(part.beat_s):g} s with both {log.channels[part.measured].path} "
            f"and {log.channels[part.reference].path}, but {LEAST_BEATS} are needed; give a longer flight."
        )
    lag = _lag(d, speed) if lagging else 0.0
    variance = max(float(np.var(d - lag * speed)), FINEST_M**2)
    return replace(part, lag_s=jnp.asarray(lag), variance=jnp.asarray(variance))


def _lag(d: np.ndarray, speed: np.ndarray) -> float:
    """Least squares of the changes of one on those of the other."""
    moved, more = speed[APART:] - speed[:-APART], d[APART:] - d[:-APART]
    # d - d' = lag (r' - r'') + noise
    power = float((moved**2).sum())
    lag = float((moved * more).sum()) / power if power > 0 else 0.0
    return float(np.clip(lag, -LONGEST_S, LONGEST_S))
