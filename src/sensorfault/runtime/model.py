"""A fitted monitor with the names of what it watches."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.core.monitor import Monitor
from sensorfault.logs.epochs import Epoch, Framing
from sensorfault.logs.table import Channel, Log, LogError, Sensor
from sensorfault.runtime import show

MOTION = "motion"  # instead of a channel: this test judges how the vehicle moves
TOGETHER = ", "  # between channels that one test accuses together
MISSED = 3.0  # a sensor is silent once it has let this many of its periods pass


@dataclass(frozen=True)
class Model:
    """What `fit` makes and `detect` needs.

    `tests` names every test in the order of the monitor's branches, as (statistic, channel path): several paths for one
    that accuses them together, None for one that finds out whom, MOTION for one of the vehicle. `tick_s` is the clock
    it was fitted on, `sigma` the standard deviation of each channel's healthy residual [SI], `summary` how it was
    fitted and what that run measured, for people.
    """

    method: str
    monitor: Monitor
    channels: tuple[Channel, ...]
    sensors: tuple[Sensor, ...]
    tests: tuple[tuple[str, str | None], ...]
    watched: tuple[bool, ...]
    tick_s: float
    sigma: tuple[float, ...]
    summary: dict[str, Any] = field(default_factory=dict)
    framing: Framing | None = None

    def __repr__(self) -> str:
        return f"<Model {show.model_line(self.method, self.sensors, self.tick_s, self.summary)}>"

    def _repr_html_(self) -> str:
        title = show.model_line(self.method, self.sensors, self.tick_s, self.summary)
        return show.model_html(title, self.channels, self.sensors, self.watched, self.summary)

    @property
    def period_s(self) -> Float[np.ndarray, " C"]:
        """The usual time between two measurements of each channel [s]."""
        period = {sensor.name: sensor.period_s for sensor in self.sensors}
        return np.array([period[channel.sensor] for channel in self.channels])

    @property
    def silent_after_s(self) -> Float[np.ndarray, " C"]:
        """A channel without a value for longer than this is silent [s]; half a tick allows for jitter.

        Satellites set: their silence is no fault.
        """
        if self.framing:
            return np.full(len(self.channels), np.inf)
        return MISSED * self.period_s + self.tick_s / 2

    @property
    def inputs(self) -> tuple[str, ...]:
        """Paths of the channels that are read, in the order in which a live sample gives them."""
        return self.framing.inputs if self.framing else tuple(channel.path for channel in self.channels)

    def take(self, log: Log) -> Log:
        """The channels of this model out of a log, in the model's order; epochs, if it judges those.

        Raises:
            LogError: a channel is missing, or the clock is not the one the model was fitted on.
        """
        if self.framing:
            framed = isinstance(log.block, Epoch) and log.channels == self.channels
            return log if framed else self.framing.frame(log)
        have = {channel.path for channel in log.channels}
        missing = [channel.path for channel in self.channels if channel.path not in have]
        if missing:
            raise LogError(
                f"{log.name} has no channel {missing[0]}, which this model was fitted on; "
                f"it has {', '.join(sorted(have))}: name the columns in vehicle.toml, or fit a model on this log."
            )
        if len(log) > 1 and not 0.5 < log.period_s / self.tick_s < 2:
            raise LogError(
                f"{log.name} ticks every {log.period_s:.4g} s, the model was fitted at {self.tick_s:.4g} s; "
                "fit a model on a log of this rate."
            )
        return log.select(channel.path for channel in self.channels)


def owners(channels: tuple[Channel, ...], sensors: tuple[Sensor, ...]) -> tuple[int, ...]:
    """Index of the sensor of each channel."""
    index = {sensor.name: i for i, sensor in enumerate(sensors)}
    return tuple(index[channel.sensor] for channel in channels)


def hold_s(log: Log) -> Float[np.ndarray, " C"]:
    """How long each channel's value and verdict stand without a new measurement [s].

    One and a half periods for a sensor slower than the clock, nothing for one that comes with every tick.
    """
    period = {sensor.name: sensor.period_s for sensor in log.sensors}
    own = np.array([period[channel.sensor] for channel in log.channels])
    return np.where(own > 1.5 * log.period_s, 1.5 * own, 0.0)


def complete(log: Log, watched: Bool[np.ndarray, " C"]) -> Bool[np.ndarray, " T"]:
    """Rows in which every watched channel has a new value."""
    rows: Bool[np.ndarray, " T"] = (log.fresh & np.isfinite(log.value))[:, watched].all(axis=1)
    return rows
