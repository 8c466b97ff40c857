"""ROS's message types -> decoders, by rosbags; nothing of ROS need be installed."""

import re
from collections.abc import Callable
from functools import cache, lru_cache
from typing import Any

Decoder = Callable[[bytes], Any]

# REP 103, and Foxglove's schemas: all in SI. The fields of the usual types that a name alone does not tell.
_UNITS = tuple(
    (re.compile(pattern), unit)
    for pattern, unit in (
        (r"(^|\.)(angular_velocity|angular)\.[xyz]$", "rad/s"),
        (r"(^|\.)linear_acceleration\.[xyz]$", "m/s^2"),
        (r"(^|\.)(linear|linear_velocity|velocity)\.[xyz]$", "m/s"),
        (r"(^|\.)position\.[xyz]$", "m"),
        (r"(^|\.)magnetic_field\.[xyz]$", "T"),
        (r"^(joints\[\d+\]\.position|position\[\d+\])$", "rad"),  # of JointStates, of a JointState
        (r"^(joints\[\d+\]\.velocity|velocity\[\d+\])$", "rad/s"),
        (r"^(joints\[\d+\]\.effort|effort\[\d+\])$", "Nm"),
        (r"^fluid_pressure$", "Pa"),
        (r"^(latitude|longitude)$", "deg"),
        (r"^(altitude|range)$", "m"),
        (r"^heading$", "rad"),  # of a LocationFix
    )
)

_KNOWN = ("sensor_msgs/", "geometry_msgs/", "nav_msgs/", "foxglove.", "foxglove_msgs/")


def si_unit_of(kind: str, field: str) -> str:
    """The unit of a field of one of ROS's or Foxglove's own types of sensors and motion; empty for others."""
    if not kind.startswith(_KNOWN):
        return ""
    return next((unit for pattern, unit in _UNITS if pattern.search(field)), "")


@lru_cache(maxsize=256)
def decoder(kind: str, definition: str, ros: int, idl: bool = False) -> Decoder | None:
    """The decoder of a message type; None if the type is unknown.

    Args:
        kind: `sensor_msgs/msg/Imu`, or `sensor_msgs/Imu` as ROS 1 says.
        definition: the type's text as the log holds it; empty if it does not, then the usual types are known.
        ros: 1 or 2: how the messages are written.
        idl: whether the text is IDL instead of ROS's own.
    """
    from rosbags.typesys import Stores, TypesysError, get_types_from_idl, get_types_from_msg, get_typestore
    from rosbags.typesys.msg import normalize_msgtype

    try:
        name = normalize_msgtype(kind)
        if definition:
            store = get_typestore(Stores.EMPTY)
            store.register(get_types_from_idl(_joined(definition)) if idl else get_types_from_msg(definition, name))
        else:
            store = _usual(ros)
        if name not in store.fielddefs:
            return None
    except (TypesysError, ValueError, KeyError, IndexError, AttributeError, TypeError, SyntaxError, RecursionError):
        return None
    read: Callable[[bytes, str], Any] = store.deserialize_ros1 if ros == 1 else store.deserialize_cdr
    return lambda raw: read(raw, name)


@cache
def _usual(ros: int) -> Any:
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS1_NOETIC if ros == 1 else Stores.LATEST)


def _joined(definition: str) -> str:
    """IDL of a type and of those that it is made of, as one text."""
    line = "=" * 80
    parts = [part.strip() for part in definition.split(line)]
    return "\n".join(part.partition("\n")[2] if part.startswith("IDL:") else part for part in parts)
