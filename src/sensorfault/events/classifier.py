"""Classify the fault of a channel: spike, offset, drift, frozen or noise, from running sums."""

from dataclasses import dataclass

import numpy as np

MOST = 1e100  # a residual counts no more than this, so that its square is a number
SURE = 3.0  # standard errors by which a mean or a slope must differ from 0


@dataclass
class FaultClassifier:
    """Running sums over the new measurements of one channel during its event.

    Offset and slope are those of the residual (measured minus expected), fitted by least squares over time.
    """

    n: int = 0
    repeats: int = 0
    start_s: float = 0.0
    end_s: float = 0.0
    last: float = float("nan")
    t: float = 0.0
    tt: float = 0.0
    r: float = 0.0
    rr: float = 0.0
    tr: float = 0.0

    def take(self, measurements: list[tuple[float, float, float]]) -> None:
        """Add new measurements: time [s], measured [SI], residual [SI]."""
        for time, measured, residual in measurements:
            if not self.n:
                self.start_s = time
            t, residual = time - self.start_s, min(max(residual, -MOST), MOST)
            self.end_s = time
            self.n += 1
            self.repeats += measured == self.last
            self.last = measured
            self.t += t
            self.tt += t * t
            self.r += residual
            self.rr += residual * residual
            self.tr += t * residual

    @property
    def size(self) -> float:
        """Root mean square of the residual [SI]."""
        return float((self.rr / max(self.n, 1)) ** 0.5)

    def kind(self, period_s: float, sigma: float) -> str:
        """spike, frozen, drift, offset or noise; unknown if the residual fits none of them.

        `period_s`: usual time between two measurements [s]. `sigma`: standard deviation of the healthy residual [SI].
        """
        if self.n == 0:
            return "unknown"
        if self.end_s - self.start_s <= 1.5 * period_s:
            return "spike"
        if self.repeats >= 0.5 * (self.n - 1):
            return "frozen"
        mean, square = self.r / self.n, self.rr / self.n
        spread = max(square - mean**2, 0.0) ** 0.5
        times = max(self.tt / self.n - (self.t / self.n) ** 2, 0.0) ** 0.5
        # least squares r = a + b t: b = cov(t, r) / var(t)
        slope = (self.tr / self.n - self.t / self.n * mean) / times**2 if times > 0 else 0.0
        left = max(spread**2 - (slope * times) ** 2, 0.0) ** 0.5
        error = max(left, sigma) / np.sqrt(self.n)
        # Drift: the ramp rises by more than it started with. Offset: else, a mean larger than the spread.
        rise = slope * np.sqrt(12) * times
        if abs(slope) * times > SURE * error and abs(rise) > abs(mean):
            return "drift"
        if abs(mean) > max(SURE * error, spread):
            return "offset"
        if spread > 2 * sigma:
            return "noise"
        return "unknown"
