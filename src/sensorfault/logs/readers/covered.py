"""Which bytes of a file belong to messages, and which do not."""

import numpy as np

from sensorfault.logs.readers.source import Damage


class Covered:
    """`end`: where the last message ends. Takes messages in the order of the file, in any number of calls."""

    def __init__(self) -> None:
        self.end = 0
        self._lost, self._first = 0, 0

    def take(self, start: np.ndarray, size: np.ndarray) -> None:
        """Messages: where in the file each begins, and its bytes."""
        order = np.argsort(start)
        ends = np.maximum.accumulate(np.concatenate([[self.end], (start + size)[order]]))
        lost = start[order] - ends[:-1]
        between = lost > 0
        if between.any() and not self._lost:
            self._first = int(ends[np.argmax(between)])
        self._lost += int(lost[between].sum())
        self.end = int(ends[-1])

    def damage(self) -> list[Damage]:
        """What lies between messages; not what is behind the last."""
        if not self._lost:
            return []
        what = f"{self._lost} bytes belong to no message, the first"
        return [Damage(what, f"byte {self._first}", "the others were read")]
