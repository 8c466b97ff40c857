"""The clock of live samples: it rises; one that is set back is followed after a while."""

import math

FOLLOWED_AFTER_S = 2.0


class LiveClock:
    """Times that rise, from times as they come."""

    def __init__(self) -> None:
        self._last = -math.inf  # on the clock that rises
        self._shift = 0.0  # what is added to a time that comes
        self._set_back: tuple[float, float] | None = None  # first and last time of a clock that was set back

    def take(self, time: float) -> float:
        """The time of a sample on the clock that rises.

        Raises:
            ValueError: it is not finite, or it did not rise; then the clock stays as it was.
        """
        if not math.isfinite(time):
            raise ValueError(f"live: time is {time}; give the time of the sample in seconds.")
        if (rising := time + self._shift) > self._last:
            self._last, self._set_back = rising, None
            return rising
        first, last = self._set_back or (time, -math.inf)
        if time <= last:
            first = time  # it does not rise on the other clock either
        self._set_back = first, time
        if time - first < FOLLOWED_AFTER_S:
            raise ValueError(
                f"live: time went from {self._last - self._shift} to {time} s; push samples in order, each once."
            )
        # The clock was set: it is followed from the last time that was taken.
        self._shift, self._set_back = self._last - first, None
        self._last = time + self._shift
        return self._last
