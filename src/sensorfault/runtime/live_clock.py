"""The clock of live samples: it rises; one that was set is followed after a while."""

import math

FOLLOWED_AFTER_S = 2.0
FAR_S = 3600.0  # one reading further ahead may be a wrong one
LARGEST_S = 1e11  # beyond it two readings of a fast sensor are one number


class LiveClock:
    """Times that rise, from times as they come."""

    def __init__(self) -> None:
        self._last = -math.inf  # on the clock that rises
        self._shift = 0.0  # what is added to a time that comes
        self._elsewhere: tuple[float, float] | None = None  # first and last time of a clock that seems to be set

    def take(self, time: float) -> float:
        """The time of a sample on the clock that rises.

        Raises:
            ValueError: it is not finite or no time in seconds, it did not rise, or it is far ahead; then the clock
                stays as it was.
        """
        if not abs(time) < LARGEST_S:
            raise ValueError(f"live: time is {time}; give the time of the sample in seconds.")
        rising = time + self._shift
        ahead = self._last + FAR_S < rising and math.isfinite(self._last)
        if rising > self._last and not ahead:
            self._last, self._elsewhere = rising, None
            return rising
        first, last = self._elsewhere or (time, -math.inf)
        if not last < time <= last + FAR_S:
            first = time  # it does not go on from the time before either
        self._elsewhere = first, time
        if time - first < FOLLOWED_AFTER_S:
            raise ValueError(
                f"live: time went from {self._last - self._shift} to {time} s; push samples in order, each once. A "
                f"clock that was set is followed after {FOLLOWED_AFTER_S:g} s."
            )
        if not ahead:  # it is followed from the last time that was taken
            self._shift = self._last - first
        self._last, self._elsewhere = time + self._shift, None
        return self._last
