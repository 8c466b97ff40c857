"""An aircraft's height: which channels of a log say how high it flies, and what moves it up and down."""

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
    """Columns of a log by what they say of an aircraft's height; None where the log does not say it.

    `height`: of the satellite receiver [m]; `barometric`: the height that the air's pressure says [m]. `vertical`: the
    receiver's vertical speed [m/s]; times `upward` it is a climb. `inertial`: the vertical speed of an inertial unit,
    with its sign; an autopilot's estimate is none, since it follows the receiver. `elevator` and `throttle` are
    commands or deflections in any unit. `accelerometer`: columns of x (forward), y
    and z (right and down, or left and up).
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
        """What else the paper's network is told, as far as it is there: pitch, throttle and elevator."""
        return tuple(i for i in (self.pitch, self.throttle, self.elevator) if i is not None)

    @property
    def unit(self) -> tuple[int, ...]:
        """Pitch, roll and the accelerometer's x, y and z, if all are there; else nothing."""
        if self.pitch is None or self.roll is None or self.accelerometer is None:
            return ()
        return (self.pitch, self.roll, *self.accelerometer)


def roles(log: Log) -> Roles:
    """The first channel of each name and unit in the log's order.

    A sensor is the receiver if its name has the word `gps` or, failing that, `gnss`, or else if it tells a latitude too
    (an autopilot's estimate does, and is called after a receiver by `init`); the barometer if its name begins with
    `baro` or `pressure`, an inertial unit with `ins`, `imu` or `inertial`. A height of nobody known is the receiver's
    where that has none.
    """
    channels = log.channels
    located = {c.sensor for c in channels if c.name == "latitude"}
    heights = [i for i, c in enumerate(channels) if c.name in _HEIGHT and si_unit(c.unit) == "m"]
    climbs = [i for i, c in enumerate(channels) if c.name in _CLIMB and si_unit(c.unit) == "m/s"]

    def strange(i: int) -> int:
        """How little the channel's sensor looks like a receiver."""
        sensor = channels[i].sensor
        words = sensor.split("_")
        near = [any(word.startswith(name) for word in words) for name in _RECEIVER]
        return [*near, sensor in located, True].index(True)

    barometric = _first(i for i in heights if channels[i].sensor.startswith(_BAROMETER))
    height = min((i for i in heights if i != barometric), key=strange, default=None)
    own = None if height is None else channels[height].sensor
    receivers = [i for i in climbs if strange(i) <= len(_RECEIVER) or channels[i].sensor == own]
    vertical = min(receivers, key=strange, default=None)
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
