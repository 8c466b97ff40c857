"""What a model finds in a log."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from jaxtyping import Float, Int8

from sensorfault.core.plotting import draw
from sensorfault.core.verdicts import UNKNOWN
from sensorfault.events.event import Event
from sensorfault.faults.fault import Fault
from sensorfault.logs.table import Log, LogError
from sensorfault.runtime import show, tables
from sensorfault.runtime.coverage import Coverage

if TYPE_CHECKING:
    from sensorfault.runtime.model import Model

PER_ROW = ("channel", "sensor", "sample", "motion", "repaired", "traces")


class RowsNotKept(LogError, AttributeError):
    """Asked for the rows of a log that was judged in parts. An AttributeError too, so that hasattr() is False."""


@dataclass(frozen=True)
class Trace:
    """One test over time: its score and its limit, NaN where there was nothing to test.

    `channel`: a path `sensor.channel`; several paths for a test that accuses them together; None for a test of all
    channels that isolates the faulty one itself; "motion" for a test of the vehicle's motion.
    """

    name: str
    channel: str | None
    score: Float[np.ndarray, " T"]
    limit: Float[np.ndarray, " T"]

    @property
    def title(self) -> str:
        """`repeats of gyro.x`; the test's name alone where it examines all channels."""
        return f"{self.name} of {self.channel}" if self.channel else self.name

    def __repr__(self) -> str:
        return f"<Trace {self.title}: {len(self.score)} rows>"


@dataclass(frozen=True)
class Detection:
    """The events in a log, and the verdict on each of its T rows, C channels and S sensors.

    A log that came in several parts (`detect_file`) was never in memory as a whole. Of its rows only the first and the
    last are kept, in `log`; reading `channel`, `sensor`, `sample`, `motion`, `repaired` or `traces` raises RowsNotKept.
    `whole` says which of the two it is.

    Args:
        log: what was judged, with the channels of the model in the model's order. `log.notes`: what reading found.
        method: the recipe of the model.
        watched: which channels were judged. The others were checked for dropouts only.
        channel: verdict on each channel: OK 0, UNKNOWN 1, FAULT 2.
        sensor: verdict on each sensor.
        sample: verdict on each row.
        motion: verdict on the vehicle's motion, UNKNOWN where the method does not judge it.
        repaired: `log.value` with stand-ins where a channel was rebuilt, NaN where there is no value to trust [SI].
        traces: every test over time.
        events: the faults, in order of their start.
        residual: measured minus expected [SI; metres where a method compares positions], NaN where it was not tested;
            None for a detection that was made by hand.
        model: what judged the log; None for a detection that was made by hand.
        fitted_on_s: from when to when the log was assumed healthy to fit `model` on it [s]; None if it was not.
        rows_left_out: how many judged rows are not in `log`.
        coverage: by the default method, which sensors were compared with which, and which were not and why.
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
    residual: Float[np.ndarray, "T C"] | None = None
    model: "Model | None" = None
    fitted_on_s: tuple[float, float] | None = None
    rows_left_out: int = 0
    coverage: Coverage | None = None

    if not TYPE_CHECKING:  # else a type checker would accept any name

        def __getattr__(self, name: str) -> Any:
            if name in PER_ROW and "log" in self.__dict__:
                raise RowsNotKept(
                    f"{self.log.name} was judged in parts and its rows were not kept, so there is no '{name}'; "
                    "read the log whole, or look at each part while it is judged (detect_file's argument `see`)."
                )
            raise AttributeError(f"{type(self).__name__} has no '{name}'")

    @property
    def whole(self) -> bool:
        """Whether the verdicts on all rows were kept."""
        return "sample" in self.__dict__

    @property
    def judged(self) -> bool:
        """Whether any row was judged; a log may be too short for that. Always true of a log that came in parts."""
        return not self.whole or bool((self.sample != UNKNOWN).any())

    @property
    def rows(self) -> int:
        """How many rows were judged."""
        return len(self.log) + self.rows_left_out

    @property
    def period_s(self) -> float:
        """The usual time between two rows [s]."""
        return self.log.period_s if self.whole or self.model is None else self.model.tick_s

    @property
    def notes(self) -> tuple[str, ...]:
        """What reading the log found, one sentence each."""
        return self.log.notes

    def without_rows(self, ends: Log, rows: int) -> "Detection":
        """The same result without the verdicts on rows. `ends`: the first and the last of the `rows` rows judged."""
        bare = replace(self, log=ends, rows_left_out=rows - len(ends), residual=None)
        for name in PER_ROW:
            del bare.__dict__[name]
        return bare

    def between(self, start_s: float = -np.inf, end_s: float = np.inf) -> "Detection":
        """The rows with start_s <= time < end_s; events that end before are left out."""
        rows = slice(*np.searchsorted(self.log.time, (start_s, end_s)))
        return replace(
            self,
            log=self.log.between(start_s, end_s),
            events=tuple(event for event in self.events if event.end_s is None or event.end_s >= start_s),
            traces=tuple(Trace(one.name, one.channel, one.score[rows], one.limit[rows]) for one in self.traces),
            residual=None if self.residual is None else self.residual[rows],
            **{name: getattr(self, name)[rows] for name in PER_ROW if name != "traces"},
        )

    def __repr__(self) -> str:
        return f"<Detection {show.line(self.log, self.method, self.events)}>"

    def _repr_html_(self) -> str:
        return show.as_html(self.log, self.method, self.events, self.sensor if self.whole else None)

    def events_table(self, pandas: bool = False) -> Any:
        """One row an event, by onset: start_s, end_s [s], subject, sensor, channel, kind, peak_score, limit, method.

        Null: an end where the event is ongoing, a sensor or channel where none can be named, a score where there is
        none. A Polars DataFrame, or a pandas one where `pandas` asks for it.

        Raises:
            ImportError: pandas is asked for and not installed.
        """
        return tables.events_table(self.events, pandas)

    def verdicts_table(self, channels: bool = False, pandas: bool = False) -> Any:
        """One row a tick: time_s [s], then `ok`, `unknown` or `fault` of `sample`, `motion` and each sensor.

        `channels`: also of each channel, `sensor.channel`. A fault of the sample with no sensor at fault means that
        nobody could be named. The words are ordered (Polars Enum, pandas Categorical): ok < unknown < fault.

        Raises:
            ImportError: pandas is asked for and not installed.
        """
        verdicts = self.sample, self.motion, self.sensor, self.channel if channels else None
        return tables.verdicts_table(self.log, *verdicts, pandas)

    def scores_table(self, pandas: bool = False) -> Any:
        """One row a tick: time_s [s], then two columns a test, `NAME of CHANNEL` and `NAME of CHANNEL, limit`.

        A test that examines all channels is `NAME`. There is a fault where the score is above the limit; both have the
        statistic's own unit. Null where the test had nothing to test. Tests that never tested anything are left out.

        Raises:
            ImportError: pandas is asked for and not installed.
        """
        return tables.scores_table(self.log, [(test.title, test.score, test.limit) for test in self.traces], pandas)

    def residuals_table(self, pandas: bool = False) -> Any:
        """One row a tick: time_s [s], then measured minus expected of each channel, `sensor.channel`.

        In SI, as the method compares them: metres for positions given in degrees. Null where the residual was not
        tested: no new measurement, not warmed up, or a channel that the method does not judge.

        Raises:
            LogError: the detection keeps no residuals.
            ImportError: pandas is asked for and not installed.
        """
        return tables.residuals_table(self.log, self.residual, pandas)

    def plot(
        self,
        truth: Sequence[Fault] = (),
        dark: bool = False,
        sensors: Sequence[str] | None = None,
        scores: bool = True,
    ) -> Any:
        """A Plotly figure of verdicts, signals and scores; see `sensorfault.plot`, which draws it."""
        return draw(self, truth=truth, dark=dark, sensors=sensors, scores=scores)

    @property
    def received(self) -> "Detection":
        """The same without satellites that were never received, if this is a log of epochs."""
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
            residual=None if self.residual is None else self.residual[:, kept],
        )
