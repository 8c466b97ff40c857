"""When MAVLink messages were measured: by the vehicle's own clock, tied to that of the ground station."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

TIMED = frozenset({"time_boot_ms", "time_usec"})  # the fields with the time; 0 where it is not known
_MS, _US, _S = 10**6, 10**3, 10**9  # [ns]
_UNIX_NS = 946_684_800 * _S  # a later reading is Unix time, an earlier one counts from the start of the autopilot
_BACK_NS = 5 * _S  # a vehicle whose clock goes back so far has started anew
_LATE_NS = 10 * _S  # no message is so long under way; one that seems to be repeats an old measurement


@dataclass(frozen=True)
class Own:
    """What a message says of its time [ns]. `now`: it was sent then; else it may repeat an old measurement."""

    time_ns: int
    now: bool

    @property
    def unix(self) -> bool:
        """Whether it is Unix time."""
        return self.time_ns > _UNIX_NS


def own_time(message: Mapping[str, Any]) -> Own | None:
    """The time in a message, None if it has none."""
    if message.get("time_boot_ms"):
        return Own(int(message["time_boot_ms"]) * _MS, now=True)
    return Own(int(message["time_usec"]) * _US, now=False) if message.get("time_usec") else None


class Clocks:
    """The clocks of several vehicles. Messages arrive late, the quickest of them hardly so: these tie the clocks.

    `see` the beginning of a file before the first `time`.
    """

    def __init__(self) -> None:
        self._offset: dict[tuple[int, bool], int] = {}
        self._last: dict[int, int] = {}

    def see(self, system: int, own: Own, received_ns: int) -> None:
        """A message of the beginning."""
        key, offset = (system, own.unix), received_ns - own.time_ns
        self._offset[key] = min(offset, self._offset.get(key, offset))

    def time(self, system: int, own: Own, received_ns: int) -> int:
        """When it was measured, on the ground station's clock [ns]."""
        key, offset = (system, own.unix), received_ns - own.time_ns
        anew = own.now and own.time_ns < self._last.get(system, 0) - _BACK_NS
        if anew or key not in self._offset:
            self._offset[key] = offset
        if own.now:
            self._last[system] = own.time_ns
        at = own.time_ns + self._offset[key]
        return at if abs(received_ns - at) < _LATE_NS else received_ns
