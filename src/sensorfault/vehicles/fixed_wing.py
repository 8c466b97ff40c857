"""An aircraft's height: the channels that measure it, and those that change it."""

from collections.abc import Iterable
from dataclasses import dataclass

from sensorfault.logs.table import Channel, Log
from sensorfault.logs.units import si_unit
from sensorfault.vehicles.car import axes

_RECEIVER, _BAROMETER, _INERTIAL = ("gps", "gnss"), ("baro", "pressure"), ("ins", "imu", "inertial")
_HEIGHT = ("altitude", "height")
_CLIMB = {"up": 1.0, "climb": 1.0, "down": -1.0, "sink": -1.0}  # a vertical speed's name, and its sign upwards
_INPUTS = {"pitch": "rad", "roll": "rad", "elevator": None, "throttle": None, "airspeed": "m/s"}


@dataclass(frozen=True)
class Roles:
    """Columns of a log that describe an aircraft's height; None where the log has no such channel.

    `height`: of the satellite receiver [m]; `barometric`: from the air pressure [m]. `vertical`: the receiver's
    vertical speed [m/s]; times `upward` it is the climb rate. `inertial`: the vertical speed of an inertial unit, with
    its sign; an autopilot's estimate does not count, because it follows the receiver. `elevator` and `throttle`:
    commands or deflections in any unit. `accelerometer`: columns of x (forward), y and z (right and down, or left and
    up).
    """

    height: int | None = None
    barometric: int | None = None
    vertical: int | None = None
    upward: float = 1.0
    inertial: int | None = None
    inertial_upward: float = 1.0
    pitch: int | None = None
    roll: int | None = None
    elevator: int | None = None
    throttle: int | None = None
    airspeed: int | None = None
    accelerometer: tuple[int, int, int] | None = None

    @property
    def inputs(self) -> tuple[int, ...]:
        """Further inputs of the paper's network that the log has: pitch, throttle and elevator."""
        return tuple(i for i in (self.pitch, self.throttle, self.elevator) if i is not None)

    @property
    def unit(self) -> tuple[int, ...]:
        """Pitch, roll and the accelerometer's x, y and z; empty if one is missing."""
        if self.pitch is None or self.roll is None or self.accelerometer is None:
            return ()
        return (self.pitch, self.roll, *self.accelerometer)


def roles(log: Log) -> Roles:
    """The first channel with each name and unit in the log's order.

    The receiver is the sensor with `gps` in its name, else with `gnss`, else one with a latitude (`init` gives an
    autopilot's estimate the name of a receiver). The barometer is the sensor whose name begins with `baro` or
    `pressure`; an inertial unit begins with `ins`, `imu` or `inertial`. A height of any other sensor is taken for the
    receiver's if the receiver has none.
    """
    channels = log.channels
    located = {c.sensor for c in channels if c.name == "latitude"}
    heights = [i for i, c in enumerate(channels) if c.name in _HEIGHT and si_unit(c.unit) == "m"]
    climbs = [i for i, c in enumerate(channels) if c.name in _CLIMB and si_unit(c.unit) == "m/s"]

    def rank(i: int) -> int:
        """Rank of the channel's sensor as a receiver, 0 for the most likely."""
        sensor = channels[i].sensor
        words = sensor.split("_")
        near = [any(word.startswith(name) for word in words) for name in _RECEIVER]
        return [*near, sensor in located, True].index(True)

    barometric = _first(i for i in heights if channels[i].sensor.startswith(_BAROMETER))
    height = min((i for i in heights if i != barometric), key=rank, default=None)
    own = None if height is None else channels[height].sensor
    receivers = [i for i in climbs if rank(i) <= len(_RECEIVER) or channels[i].sensor == own]
    vertical = min(receivers, key=rank, default=None)
    inertial = _first(i for i in climbs if i not in receivers and channels[i].sensor.startswith(_INERTIAL))
    found = {name: _called(channels, name, unit) for name, unit in _INPUTS.items()}
    return Roles(
        height=height,
        barometric=barometric,
        vertical=vertical,
        upward=_sign(channels, vertical),
        inertial=inertial,
        inertial_upward=_sign(channels, inertial),
        **found,
        accelerometer=axes(channels, "m/s^2"),
    )


def _called(channels: tuple[Channel, ...], name: str, unit: str | None) -> int | None:
    return _first(i for i, c in enumerate(channels) if c.name == name and unit in (None, si_unit(c.unit)))


def _sign(channels: tuple[Channel, ...], at: int | None) -> float:
    return 1.0 if at is None else _CLIMB[channels[at].name]


def _first(found: Iterable[int]) -> int | None:
    return next(iter(found), None)
