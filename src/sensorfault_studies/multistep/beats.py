"""A flight averaged to beats: the signal that a test of a slow drift gets, and the injected ramps."""

from dataclasses import dataclass, replace

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.calibration.open_loop import extra_tape
from sensorfault.logs.table import Log, Sensor
from sensorfault.methods.height import drifting
from sensorfault.methods.height.drift_setting import Setting
from sensorfault.stages.residual.difference import Difference
from sensorfault.vehicles.fixed_wing import roles


@dataclass(frozen=True)
class Beats:
    """A flight averaged to beats: a log of height minus barometer, corrected for lag, and zeros to compare it with.

    `half`: when the second half begins [s]. `when`: the mean time of the fixes of each beat [s].
    """

    log: Log
    when: Float[np.ndarray, " T"]
    half: float
    fitted: Difference

    @classmethod
    def of(cls, name: str, whole: Log, setting: Setting) -> "Beats":
        """The lag is fitted on the first half."""
        half = float(whole.time[0]) + whole.duration_s / 2
        part = drifting.difference(name, whole.between(end_s=half), setting)
        beat = extra_tape(part, whole)
        rows = beat.closed
        e = beat.difference[rows] - float(part.lag_s) * beat.speed[rows]
        pair = whole.select(whole.channels[c].path for c in (part.measured, part.reference))
        value = np.column_stack([e, np.zeros_like(e)])
        log = replace(
            pair,
            time=whole.time[rows],
            value=value,
            fresh=np.isfinite(value),
            sensors=tuple(Sensor(sensor.name, setting.beat_s) for sensor in pair.sensors),
        )
        plain = replace(part, lag_s=jnp.zeros(()), measured=0, reference=1, channels=2)
        return cls(log, beat.time[rows], half, plain)

    def with_ramp(self, rate: float, onset_s: float) -> Log:
        """The log with this ramp on the height."""
        ramp = rate * np.maximum(self.when - onset_s, 0.0)
        return replace(self.log, value=self.log.value + np.column_stack([ramp, 0 * ramp]))


def compared(whole: Log) -> Log:
    """A flight with only its two heights, and only ticks with a new value of one of them."""
    columns = roles(whole)
    pair = whole.select(whole.channels[c].path for c in (columns.height, columns.barometric) if c is not None)
    return pair.without(np.flatnonzero(~pair.fresh.any(axis=1)))
