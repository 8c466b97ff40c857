"""What the difference of two heights is on a healthy flight: the lag of one behind the other, and its spread."""

from dataclasses import replace

import jax.numpy as jnp
import numpy as np

from sensorfault.calibration.open_loop import extra_tape
from sensorfault.logs.table import Log, LogError
from sensorfault.stages.residual.difference import Difference

APART = 10  # beats: what wanders over minutes is no lag
LONGEST_S = 3.0  # no barometer and no receiver is later
LEAST_BEATS = 60
FINEST_M = 0.01


def fit_difference(part: Difference, log: Log, lagging: bool = True) -> Difference:
    """With the lag that makes the difference least when the reference moves, and with its variance around its mean.

    `lagging` False: both are taken to show the same moment.

    Raises:
        LogError: too few beats with both sensors.
    """
    beat = extra_tape(part, log)
    d, speed = beat.difference[beat.closed], beat.speed[beat.closed]
    if len(d) < LEAST_BEATS:
        raise LogError(
            f"{log.name} has {len(d)} beats of {float(part.beat_s):g} s with both {log.channels[part.measured].path} "
            f"and {log.channels[part.reference].path}, their difference needs {LEAST_BEATS}; give it a longer flight."
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
