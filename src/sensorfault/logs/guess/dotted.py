"""Columns named `sensor.channel`, as the program itself writes them: the first part is the sensor."""

import re
from collections.abc import Sequence
from dataclasses import replace

from sensorfault.logs.guess.words import Meaning, read_name

_DOTTED = re.compile(r"([A-Za-z][A-Za-z0-9_]*)\.([A-Za-z][A-Za-z0-9_]*)")
# What `rostopic echo -p` writes before each name, and quantities, as messages of ROS have them: no devices.
_NO_DEVICE = re.compile(
    r"field|((linear|angular)_?)?(acceleration|velocity|twist|rate)|orientation|(delta_?)?position|pose|quaternion|linear|angular",
    re.IGNORECASE,
)
_MOST = 0.8  # share of the columns that must have such names
_VELOCITY = ("north", "east", "down", "up", "forward", "right", "left")


def device_of(name: str) -> str:
    """`gnss` of `gnss.north`; empty if the name is of another form."""
    match = _DOTTED.fullmatch(name)
    return match[1] if match and not _NO_DEVICE.fullmatch(match[1]) else ""


def are_dotted(names: Sequence[str]) -> bool:
    """Whether a table names its columns so."""
    return sum(bool(device_of(name)) for name in names) >= _MOST * max(len(names) - 1, 1)


def meaning_of(name: str) -> Meaning:
    """What `sensor.channel` means: by both words together, by the second alone, or by the device."""
    match = _DOTTED.fullmatch(name)
    assert match is not None
    device, channel = match[1].lower(), match[2]
    together, alone = read_name(name), read_name(channel)
    if re.fullmatch(r"[GRECJS]\d\d", match[1]):  # a satellite: places and ranges, no measurement of motion by itself
        unit = alone.unit or {"m": "m", "hz": "Hz", "s": "s"}.get(channel.rpartition("_")[2], "")
        return Meaning("satellite", channel, "", unit)
    if channel in _VELOCITY and re.search(r"gnss|gps|dvl|vel", device):
        return Meaning("velocity", channel, "", "m/s")
    if alone.kind in ("depth", "range", "position", "heading", "airspeed"):
        return replace(alone, axis=channel, stem="")
    if device == "control":
        return Meaning("", channel, "", "")
    return replace(together, axis=channel, stem="")
