"""A fitted monitor, with the names of its channels, sensors and tests."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np
from jaxtyping import Float

from sensorfault.core.monitor import Monitor
from sensorfault.logs.epochs import Epoch, Framing
from sensorfault.logs.rates import MISSED
from sensorfault.logs.table import Channel, Log, LogError, Sensor
from sensorfault.logs.vehicle import VehicleFile
from sensorfault.runtime import described, show

MOTION = "motion"  # in place of a channel: this test judges the motion of the vehicle
TOGETHER = ", "  # joins channels that one test accuses together


@dataclass(frozen=True)
class Model:
    """A fitted model: `fit` returns one, `detect` takes one. It has C channels.

    Args:
        method: the recipe it was made by.
        monitor: the fitted parts.
        channels: what it judges, in the order of the monitor's columns.
        sensors: the sensors of these channels.
        tests: every test in the order of the monitor's branches, as (statistic, channel path). Several paths for a test
            that accuses them together, None for one that isolates the faulty channel, MOTION for one of the vehicle.
        watched: which channels are judged. The others are checked for dropouts only.
        tick_s: time between two rows of the log it was fitted on [s].
        sigma: standard deviation of each channel's healthy residual [SI].
        summary: how it was fitted, and what was measured then; for people.
        framing: how to cut raw satellite data into epochs, for a model that judges epochs.
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

    @cached_property
    def description(self) -> VehicleFile | None:
        """What the columns of the log were read as that it was fitted on; give it to `read` as `model`.

        None if the log was made by hand, or the model was written by a version that did not keep it.

        Raises:
            LogError: what the model file says of it cannot be read.
        """
        return described.known(self.summary, self.inputs, self.sensors)

    @property
    def period_s(self) -> Float[np.ndarray, " C"]:
        """The usual time between two measurements of each channel [s]."""
        period = {sensor.name: sensor.period_s for sensor in self.sensors}
        return np.array([period[channel.sensor] for channel in self.channels])

    @property
    def silent_after_s(self) -> Float[np.ndarray, " C"]:
        """How long each channel may be without a value until it is silent [s]; half a tick allows for jitter.

        Infinite for satellites, which set.
        """
        if self.framing:
            return np.full(len(self.channels), np.inf)
        return MISSED * self.period_s + self.tick_s / 2

    @property
    def inputs(self) -> tuple[str, ...]:
        """Paths of the channels to read, in the order of a live sample."""
        return self.framing.inputs if self.framing else tuple(channel.path for channel in self.channels)

    def sample(self, row: Mapping[str, float]) -> Float[np.ndarray, " C"]:
        """One row of the log's columns, by name and in the units of the log, as the values of a live sample [SI].

        A column that is not in the row has no value. `live.push(time_s, model.sample({"gx_deg": 3.1, ...}))`

        Raises:
            LogError: the model does not know the columns, or none of them is in the row.
        """
        return described.sample(self.description, self.inputs, row)

    def take(self, log: Log) -> Log:
        """The log with only the channels of this model, in the model's order; as epochs, if the model judges those.

        Raises:
            LogError: a channel is missing; the log is sampled at another rate than the model was fitted at; or its
                columns were read as something else.
        """
        described.check(log, self.description)
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
                f"{log.name} has a row every {log.period_s:.4g} s, but the model was fitted on one every "
                f"{self.tick_s:.4g} s; fit a model on a log of the same rate."
            )
        return log.select(channel.path for channel in self.channels)


def owners(channels: tuple[Channel, ...], sensors: tuple[Sensor, ...]) -> tuple[int, ...]:
    """Index of the sensor of each channel."""
    index = {sensor.name: i for i, sensor in enumerate(sensors)}
    return tuple(index[channel.sensor] for channel in channels)
