"""Lines, verdicts and tests as the page draws them, gathered part by part."""

from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Bool, Float, Int8

from sensorfault.report.page_lines import line, runs
from sensorfault.runtime.result import Trace

GAP = 3.0  # median steps


class Stroke:
    """One line. `count`: how many values it is drawn from."""

    def __init__(self) -> None:
        self.count = 0
        self._x: list[Float[np.ndarray, " k"]] = []
        self._y: list[Float[np.ndarray, " k"]] = []
        self._last_s = np.nan

    def add(
        self, time: Float[np.ndarray, " T"], value: Float[np.ndarray, " T"], keep: Bool[np.ndarray, " T"], points: int
    ) -> None:
        """Add the next part, with about `points` points, all of `keep` among them."""
        at = time[np.isfinite(value)]
        if not at.size:
            return
        x, y = line(time, value, keep, points)
        if at.size > 1 and at[0] - self._last_s > GAP * np.median(np.diff(at)):
            x, y = np.insert(x, 0, (at[0] + self._last_s) / 2), np.insert(y, 0, np.nan)
        self._x.append(x)
        self._y.append(y)
        self.count += at.size
        self._last_s = float(at[-1])

    @property
    def x(self) -> Float[np.ndarray, " K"]:
        return np.concatenate([np.zeros(0), *self._x])

    @property
    def y(self) -> Float[np.ndarray, " K"]:
        return np.concatenate([np.zeros(0), *self._y])


class Lane:
    """The verdicts on one sensor: `start` [s] of each run of the same verdict, and the verdict."""

    def __init__(self) -> None:
        self.start: list[float] = []
        self.verdict: list[int] = []

    def add(self, time: Float[np.ndarray, " T"], verdict: Int8[np.ndarray, " T"], most: int) -> None:
        """Add the next part, as at most `most` runs."""
        start, value = runs(verdict, most)
        if self.verdict and value[:1].tolist() == self.verdict[-1:]:  # the last run continues
            start, value = start[1:], value[1:]
        self.start += time[start].tolist()
        self.verdict += value.tolist()


@dataclass
class Drawn:
    """One channel: measurements, values that were only held, and the stand-in."""

    measured: Stroke = field(default_factory=Stroke)
    held: Stroke = field(default_factory=Stroke)
    stand_in: Stroke = field(default_factory=Stroke)
    fresh_s: float = -np.inf  # time of the last measurement [s]


class Tested:
    """One test: its score and limit."""

    def __init__(self, trace: Trace) -> None:
        self.name, self.channel = trace.name, trace.channel
        self.score, self.limit = Stroke(), Stroke()
        self._sizes: list[tuple[float, float, float]] = []  # least, median and greatest score of each part

    def add(self, time: Float[np.ndarray, " T"], trace: Trace, keep: Bool[np.ndarray, " T"], points: int) -> None:
        """Add the next part."""
        self.limit.add(time, trace.limit, keep, points // 4)
        self.score.add(time, trace.score, keep, points)
        finite = trace.score[np.isfinite(trace.score)]
        if finite.size:
            self._sizes.append((float(finite.min()), float(np.median(finite)), float(finite.max())))

    @property
    def spans_much(self) -> bool:
        """Whether the score needs a logarithmic axis: it is positive, and its peak is far above the median."""
        if not self._sizes:
            return False
        least, usual, greatest = np.array(self._sizes).T
        return bool(least.min() > 0 and greatest.max() > 30 * np.median(usual))
