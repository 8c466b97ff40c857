"""A log of ranges to fixed beacons, with the vehicle's own channels."""

from collections.abc import Mapping

import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import Channel, Log, Sensor

START = (Channel("north", "start", "m", watch=False), Channel("east", "start", "m", watch=False))
TAG = Channel("depth", "tag", "m", watch=False)
PLACE = ("north", "east", "depth")  # channels of a beacon's position [m]


def ranged_log(
    name: str,
    time: Float[np.ndarray, " T"],
    own: Mapping[Channel, Float[np.ndarray, " T"]],
    ranges: Mapping[str, Float[np.ndarray, " T"]],
    beacons: Float[np.ndarray, "L 3"] | None = None,
) -> Log:
    """Own channels in their units; for each beacon its range [m] and, if given, its position: north, east, down [m].

    NaN where there is no value; every value is new.
    """
    channels, columns = list(own), list(own.values())
    for j, (beacon, range_m) in enumerate(ranges.items()):
        channels.append(Channel("range", beacon, "m"))
        columns.append(range_m)
        for what, at in zip(PLACE, [] if beacons is None else beacons[j], strict=beacons is not None):
            channels.append(Channel(what, beacon, "m", watch=False))
            columns.append(np.full(len(time), at))
    value = np.column_stack(columns)
    return Log(time, value, np.isfinite(value), tuple(channels), _sensors(channels, value, time), name)


def _sensors(
    channels: list[Channel], value: Float[np.ndarray, "T C"], time: Float[np.ndarray, " T"]
) -> tuple[Sensor, ...]:
    """The sensors; the period is the median time between two values of the first channel."""
    first = {channel.sensor: column for channel, column in reversed(list(zip(channels, value.T, strict=True)))}
    return tuple(
        Sensor(name, _period(time[np.isfinite(first[name])])) for name in dict.fromkeys(c.sensor for c in channels)
    )


def _period(times: Float[np.ndarray, " n"]) -> float:
    return float(np.median(np.diff(times))) if len(times) > 1 else 1.0
