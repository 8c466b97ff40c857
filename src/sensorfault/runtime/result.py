"""What a fitted monitor found in a log."""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float, Int8

from sensorfault.core.types import FAULT
from sensorfault.events.event import Event
from sensorfault.logs.table import Log
from sensorfault.runtime.model import Model
from sensorfault.runtime.replay import Replayed


@dataclass(frozen=True)
class Trace:
    """One test over time: its score and limit, NaN where it had nothing to test.

    `channel`: a path, several paths for a test that accuses them together, None for one that finds out whom, "motion".
    """

    name: str
    channel: str | None
    score: Float[np.ndarray, " T"]
    limit: Float[np.ndarray, " T"]


@dataclass(frozen=True)
class Detection:
    """Verdicts (OK 0, UNKNOWN 1, FAULT 2) on every tick of `log`, the tests behind them, and the fault events.

    `motion` is the verdict on the vehicle's motion, where the method judges it.
    `watched` says which channels were judged; of the others only silence was noticed.
    `repaired` is `log.value` with stand-ins where a channel was rebuilt, NaN where there was nothing to say [SI].
    """

    log: Log
    method: str
    watched: tuple[bool, ...]
    channel: Int8[np.ndarray, "T C"]
    sensor: Int8[np.ndarray, "T S"]
    sample: Int8[np.ndarray, " T"]
    motion: Int8[np.ndarray, " T"]
    repaired: Float[np.ndarray, "T C"]
    traces: tuple[Trace, ...]
    events: tuple[Event, ...]

    @property
    def received(self) -> "Detection":
        """Of a log of epochs, without the satellites that never rose."""
        kept = np.isfinite(self.log.value).any(axis=0)
        if not self.log.block or kept.all() or not kept.any():
            return self
        log = self.log.select([channel.path for channel, k in zip(self.log.channels, kept, strict=True) if k])
        mine = [sensor in log.sensors for sensor in self.log.sensors]
        return replace(
            self,
            log=log,
            watched=tuple(one for one, k in zip(self.watched, kept, strict=True) if k),
            channel=self.channel[:, kept],
            sensor=self.sensor[:, mine],
            repaired=self.repaired[:, kept],
        )


def detected(model: Model, log: Log, result: Replayed, events: Iterable[Event]) -> Detection:
    """What a model's monitor said of every row of a log it has taken, and the events in it."""
    doubtful = np.isnan(log.value) | log.fresh | (np.asarray(result.channel) == FAULT)
    lost = ~np.asarray(result.believed) & doubtful
    return Detection(
        log=log,
        method=model.method,
        watched=model.watched,
        channel=np.asarray(result.channel),
        sensor=np.asarray(result.sensor),
        sample=np.asarray(result.sample),
        motion=np.asarray(result.motion),
        repaired=np.where(lost, np.nan, np.asarray(result.value)),
        traces=_traces(model, result),
        events=tuple(events),
    )


def _traces(model: Model, result: Replayed) -> tuple[Trace, ...]:
    score, limit = (np.concatenate([np.asarray(x) for x in xs], axis=1) for xs in (result.scores, result.limits))
    return tuple(
        Trace(name, channel, score[:, k], limit[:, k])
        for k, (name, channel) in enumerate(model.tests)
        if np.isfinite(score[:, k]).any()
    )
