"""What the methods of this family need of a log. Each raises LogError if the log lacks it; nothing is fitted."""

from typing import NamedTuple

from sensorfault.logs.table import Log, LogError
from sensorfault.methods.height.heights import Heights
from sensorfault.vehicles.fixed_wing import roles

SOURCES = ("receiver", "inertial", "barometric")


class ClimbSource(NamedTuple):
    """The column of a climb rate, or of a height (`speed` false); `upward`: 1, or -1 for a speed that is positive down.

    A fixed order of sources decides where a log has several.
    """

    column: int
    upward: float
    speed: bool


def two_heights(name: str, log: Log) -> tuple[int, int]:
    """Columns of the receiver's height and of the barometer's height.

    Raises:
        LogError: the log lacks one of them.
    """
    found = roles(log)
    if found.height is None or found.barometric is None:
        lacks = "no height of a satellite receiver" if found.height is None else "no height of a barometer"
        raise LogError(
            f"{log.name} has {lacks}, but {name} compares both; name the columns in vehicle.toml, or take a method "
            "that needs only one."
        )
    return found.height, found.barometric


def height_sources(name: str, log: Log) -> dict[int, float]:
    """Columns of all sources of the height, with the sign of a vertical speed, 0 for a height; the receiver's first.

    Raises:
        LogError: fewer than two.
    """
    found = roles(log)
    heights = [(c, 0.0) for c in (found.height, found.barometric) if c is not None]
    speeds = [(found.vertical, found.upward), (found.inertial, found.inertial_upward)]
    sources = dict([*heights, *((c, sign) for c, sign in speeds if c is not None)])
    if not heights or len(sources) < 2:
        raise LogError(
            f"{log.name} has {len(sources)} channels of its height (altitude [m], vertical speed [m/s]), but {name} "
            "compares at least two, one of them an altitude; name the columns in vehicle.toml, or take another method."
        )
    return sources


def height_and_inputs(name: str, log: Log) -> tuple[Heights, tuple[int, ...]]:
    """The height, and the columns of what it is predicted from.

    Raises:
        LogError: no height, or none of the inputs.
    """
    heights = Heights.of(name, log)
    found = heights.roles
    climb = found.vertical if found.vertical is not None else found.inertial
    columns = tuple(i for i in (climb, *found.inputs) if i is not None)
    if not columns:
        raise LogError(
            f"{log.name} has no vertical speed, pitch, throttle or elevator, from which {name} predicts the height; "
            "name the columns in vehicle.toml, or take another method."
        )
    return heights, columns


def height_and_climb(name: str, log: Log, source: str = "") -> tuple[Heights, ClimbSource]:
    """The height, and this source of its climb rate; without a name the first of SOURCES that the log has.

    Raises:
        LogError: no height, the source is unknown, or the log does not have it.
    """
    heights = Heights.of(name, log)
    found = heights.roles
    baro = found.barometric if found.barometric != heights.column else None
    have = {
        "receiver": (found.vertical, found.upward, True),
        "inertial": (found.inertial, found.inertial_upward, True),
        "barometric": (baro, 1.0, False),
    }
    if source and source not in SOURCES:
        raise LogError(f"{name} knows no vertical speed source '{source}'; take one of {', '.join(SOURCES)}.")
    for one in (source,) if source else SOURCES:
        column, upward, speed = have[one]
        if column is not None:
            return heights, ClimbSource(column, upward, speed)
    what = f"no {source} vertical speed" if source else "neither a vertical speed nor a second height"
    raise LogError(
        f"{log.name} has {what}, from which {name} predicts {log.channels[heights.column].path}; name the columns in "
        "vehicle.toml, or take another method."
    )
