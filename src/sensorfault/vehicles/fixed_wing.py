"""An aircraft's height: which channels of a log say how high it flies, and what moves it up and down."""

from collections.abc import Iterable
from dataclasses import dataclass

from sensorfault.logs.table import Channel, Log
from sensorfault.logs.units import si_unit
from sensorfault.vehicles.car import axes

_RECEIVER, _BAROMETER = ("gnss", "gps"), ("baro", "pressure")
_HEIGHT = ("altitude", "height")
_CLIMB = {"up": 1.0, "climb": 1.0, "down": -1.0, "sink": -1.0}  # a vertical speed's name, and its sign upwards
_INPUTS = {"pitch": "rad", "roll": "rad", "elevator": None, "throttle": None, "airspeed": "m/s"}


@dataclass(frozen=True)
class Roles:
    """Columns of a log by what they say of an aircraft's height; None where the log does not say it.

    `height`: of the satellite receiver [m]; `barometric`: the height that the air's pressure says [m]. `vertical`: the
    receiver's vertical speed [m/s]; times `upward` it is a climb. `inertial`: another sensor's vertical speed, with its
    sign. `elevator` and `throttle` are commands or deflections in any unit. `accelerometer`: columns of x (forward), y
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

    A height is the receiver's if its sensor is called `gnss..` or `gps..` or tells a latitude too, the barometer's if
    its sensor is called `baro..` or `pressure..`; a height of nobody known is the receiver's where that has none.
    """
    channels = log.channels
    receivers = {c.sensor for c in channels if c.name == "latitude" or c.sensor.startswith(_RECEIVER)}
    heights = [i for i, c in enumerate(channels) if c.name in _HEIGHT and si_unit(c.unit) == "m"]
    climbs = [i for i, c in enumerate(channels) if c.name in _CLIMB and si_unit(c.unit) == "m/s"]
    barometric = _first(i for i in heights if channels[i].sensor.startswith(_BAROMETER))
    others = [i for i in heights if i != barometric]
    height = _first([i for i in others if channels[i].sensor in receivers] or others)
    own = None if height is None else channels[height].sensor
    vertical = _first(i for i in climbs if channels[i].sensor in {own, *receivers})
    inertial = _first(i for i in climbs if channels[i].sensor not in {own, *receivers})
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
