"""Devices without a valid measurement while the others go on."""

from collections.abc import Iterator

import numpy as np

from sensorfault.relations.levels.finding import Finding, device_of
from sensorfault.relations.signals import RANGE_ROLE, SATELLITES, Signal

SILENT_S, SILENT_PERIODS = 3.5, 5.0
SETTLED = 2  # measurements before which a device has not begun


def silences(signals: dict[str, Signal], pieces: list[tuple[float, float]], vehicle: str) -> Iterator[Finding]:
    """Devices without a valid measurement while the others go on; not before their first few.

    A receiver under water has nothing to receive. Satellites rise, set, and hide behind a tunnel.
    """
    signals = {key: one for key, one in signals.items() if one.role != RANGE_ROLE and one.sensor != SATELLITES}
    for device in dict.fromkeys(device_of(signal) for signal in signals.values()):
        if vehicle == "underwater" and device.startswith("gnss"):
            continue
        mine = [signal for signal in signals.values() if device_of(signal) == device]
        limit = max(SILENT_S, SILENT_PERIODS * min(signal.period_s for signal in mine))
        time = np.unique(np.concatenate([signal.time for signal in mine]))
        for start, end in pieces:
            inside = time[(time >= start) & (time <= end)]
            begun = len(time) > SETTLED and time[SETTLED] < start
            inside = inside if begun else inside[SETTLED:]
            stops = np.r_[start if begun else np.zeros(0), inside, end] if len(inside) or begun else np.zeros(0)
            for i in np.flatnonzero(np.diff(stops) > limit):
                yield Finding(
                    device,
                    float(stops[i]),
                    float(stops[i + 1]),
                    "silence",
                    float(stops[i + 1] - stops[i]),
                    limit,
                    "missing",
                )
