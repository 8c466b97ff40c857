"""What the name of a column means: kind of sensor, axis, unit."""

import re
from collections.abc import Collection
from dataclasses import dataclass

from sensorfault.logs.units import known, spelled

# Names that are not measurements of motion: quality, state, statistics. It may be added by hand.
_QUALITY = re.compile(
    r"(^|_)([ghptv]dop|dop|ep[ehv]|sd[neu]+|sdv[neu]+|std|stddev|sigma|cov(ariance)?|var(iance)?|accuracy|acc_?est|"
    r"fix|fix_?type|fix_?quality|quality|q|ns|sats?|satellites?|numsats?|num_?sv|ratio|age|confidence|noise|jamming|"
    r"rssi|nsd|snr|cn0|valid|ok|status|state|mode|flags?|health|error|errors|error_?count|count|counter|id|seq|"
    r"progress|week|leap|cycle|enabled|present|delta|reset|ref|max|min|terrain|setpoint|sp|des|desired|cmd|command|bias)(_|$)"
)
_TIME = re.compile(
    r"(^|_)(time|timestamp|stamp|t|tow|gps_?tow|itow|epoch|utc|date|datetime|millis|micros|msec|usec|clock|"
    r"time_?startup|etime|seconds|secs?)(_|$)|^time|time$|timestamp"
)
_AXIS = r"(?P<axis>[xyz]|[nedu]|north|east|down|up|lateral|longitudinal|vertical|forward|left|right)"

# (kind, pattern on the normalised name); the first that matches wins.
_KINDS: tuple[tuple[str, re.Pattern[str]], ...] = tuple(
    (kind, re.compile(pattern))
    for kind, pattern in (
        ("gyro", r"(^|_)(?P<axis>roll|pitch|yaw)_?(rate|speed)$"),
        (
            "gyro",
            r"(^|_)(?P<axis>turn_?rate|ang(ular)?_?(rate|vel|velocity|speed))$",
        ),  # in a plane
        ("gyro", rf"(^|_)(gyros?|gyr|gyroscope|omega|twist_angular|ang(ular)?_?(rate|vel|velocity|speed)|w)_?{_AXIS}$"),
        ("accelerometer", rf"(^|_)(a|acc|accel|(linear_)?acceleration|accelerometer|specific_force)_?{_AXIS}$"),
        ("magnetometer", rf"(^|_)(m|mag|magnetometer|magnetic|magnetic_field|compass)_?{_AXIS}$"),
        ("quaternion", r"(^|_)(q|quat|quaternion|orientation)_?(?P<axis>[0-3wxyz])$"),
        ("attitude", r"(^|_)(?P<axis>roll|pitch)(_of_quaternion)?$|^(?P<alone>phi|theta)$"),
        (
            "heading",
            r"(^|_)(?P<axis>yaw|heading|course|cog|hdt|hdg|track|azimuth|orientation|g?crs)(_of_quaternion)?$|^(?P<alone>psi)$",
        ),
        ("wheels", r"(^|_)wheel_?speeds?_(?P<axis>[a-z]+(_[a-z]+)*)$"),
        ("airspeed", r"(^|_)(?P<axis>([a-z]+_)?air_?speed(_[a-z]+)?|ias|tas)$"),
        ("velocity", rf"(^|_)(v|vel|(linear_)?velocity|twist_linear|wind_?speed)_?{_AXIS}$"),
        ("speed", r"(^|_)(?P<axis>speed|sog|spd|ground_?speed|vel|velocity|wheel_?speed)$"),
        ("steering", r"(^|_)(steer(ing)?|road_?wheel)(_?wheel)?_?(?P<axis>angle)$"),
        ("position", r"(^|_)(?P<axis>lat|latitude|lon|lng|longitude)$"),
        ("height", r"(^|_)(?P<axis>alt|altitude|height|hgt|elevation|altitude_filtered|orthometric_height)(_|$)"),
        ("local_position", rf"(^|_)(pos|position)_?{_AXIS}$|^(field_)?(?P<alone>[xyz])$"),
        ("range", r"(^|_)(dist|distance|range)(_?(?P<axis>[a-z]*\d+)|_from_tag|_bottom)?$"),
        ("depth", r"(^|_)(?P<axis>depth)$"),
        ("barometer", r"(^|_)(?P<axis>pres|pressure|baro)(_|$)"),
        ("temperature", r"(^|_)(?P<axis>temp|temperature)(_|$)"),
    )
)
_CHANNEL = {
    "roll": "roll", "pitch": "pitch", "yaw": "yaw", "lat": "latitude", "lon": "longitude", "lng": "longitude",
    "alt": "altitude", "hgt": "height", "cog": "course", "hdt": "heading", "hdg": "heading", "sog": "speed",
    "n": "north", "e": "east", "d": "down", "u": "up", "vel": "speed", "velocity": "speed", "pres": "pressure",
    "temp": "temperature", "baro": "pressure", "spd": "speed", "crs": "course", "gcrs": "course", "phi": "roll",
    "theta": "pitch", "psi": "yaw",
}  # fmt: skip
_STEM = {"bar": "baro"}  # DataFlash's BarAlt
_GYRO_AXIS = {"roll": "x", "pitch": "y", "yaw": "z"}
# EuRoC's names, as `w_RS_S_x`: what is measured, of which frame, in which frame, along which axis.
_FRAMED = re.compile(r"(?P<bias>b_)?(?P<what>[wavpq])_rs(_[rs])?_(?P<axis>[wxyz])")
_OF_FRAMED = {"w": "gyro", "a": "accelerometer", "v": "velocity", "p": "local_position", "q": "quaternion"}
RECEIVERS = re.compile(r"(^|_)(gps|gnss)(_|$)")

_OF_JOINTS = ("rad", "Nm")  # units of no axes in space, but of an arm's joints

# Units written as the end of a name.
_UNIT_ENDINGS = (
    ("m_s2", "m/s^2"), ("m_s_2", "m/s^2"), ("mps2", "m/s^2"), ("rad_s", "rad/s"), ("radps", "rad/s"),
    ("deg_s", "deg/s"), ("degps", "deg/s"), ("dps", "deg/s"), ("m_s", "m/s"), ("mps", "m/s"), ("km_h", "km/h"),
    ("kmh", "km/h"), ("kph", "km/h"), ("knots", "kn"), ("rad", "rad"), ("degrees", "deg"), ("deg", "deg"),
    ("ga", "gauss"), ("gauss", "gauss"), ("meter", "m"), ("meters", "m"), ("mph", "mph"), ("feet", "ft"), ("ut", "uT"),
    ("hpa", "hPa"), ("kpa", "kPa"), ("pa", "Pa"), ("celsius", "degC"), ("degc", "degC"),
    ("mm", "mm"), ("ft", "ft"),
)  # fmt: skip


@dataclass(frozen=True)
class Meaning:
    """`kind`: of sensor, "quality", "time" or "" for unknown; `stem`: what else the name says, e.g. "uncomp"."""

    kind: str
    axis: str
    stem: str
    unit: str


def read_name(column: str, unit: str = "", others: Collection[str] = ()) -> Meaning:
    """What a column's name says; `unit`: what its format says.

    An array's elements may be axes, `gyro_rad[0]` is x, if it has no more than three among the `others`.
    """
    element = re.fullmatch(r"(.+)\[([012])\]", column)
    if element and f"{element[1]}[3]" not in others and unit not in _OF_JOINTS:
        plain, ending = _without_unit("_".join(_tokens(element[1])))
        axis = _read(f"{plain}_{'xyz'[int(element[2])]}", unit or ending)
        if axis.kind not in ("", "quality", "quaternion", "time"):
            return axis
    plain, bracket = _split_unit(column)
    bare, ending = _without_unit("_".join(_tokens(plain)) or re.sub(r"\W+", "_", column).lower())
    return _beside(bare, unit or bracket or ending, others) or _read(bare, unit or bracket or ending)


def _beside(bare: str, unit: str, others: Collection[str]) -> Meaning | None:
    """What a short name means beside the names of the others; None if they say no more than it does."""
    framed = _FRAMED.fullmatch(bare)
    if framed:
        kind = _OF_FRAMED[framed["what"]]
        return Meaning("quality", bare, "", unit) if framed["bias"] else Meaning(kind, framed["axis"], "", unit)
    angle = re.fullmatch(r"(?P<stem>.*?)_?orientation_(?P<axis>[xyz])", bare)
    if len(bare) > 5 and angle is None:
        return None
    names = {"_".join(_tokens(_split_unit(other)[0])) for other in others}
    if angle is not None and bare[:-1] + "w" not in names:  # three numbers are angles
        name = {"x": "roll", "y": "pitch", "z": "yaw"}[angle["axis"]]
        return Meaning("heading" if name == "yaw" else "attitude", name, angle["stem"], unit)
    if re.fullmatch(r"g_?[xyz]", bare) and {bare.replace("g", "a", 1), bare.replace("g", "acc", 1)} & names:
        return Meaning("gyro", bare[-1], "", unit)
    if re.fullmatch(r"t[xyz]", bare) and {"qx", "qy", "qz", "qw"} <= names:
        return Meaning("local_position", bare[-1], "", unit)
    if bare in ("w", "x", "y", "z") and {"w", "x", "y", "z"} <= names:
        return Meaning("quaternion", bare, "", unit)
    if bare == "theta" and {"x", "y"} <= names:
        return Meaning("heading", "heading", "", unit)
    return None


def _without_unit(name: str) -> tuple[str, str]:
    """A name without the unit that it ends with, and the unit."""
    for ending, unit in _UNIT_ENDINGS:
        if name.endswith("_" + ending):
            return name[: -len(ending) - 1], unit
    return name, ""


def _read(bare: str, unit: str) -> Meaning:
    if _TIME.search(bare) and not re.search(r"(^|_)(lat|lon)", bare):
        return Meaning("time", bare, "", unit)
    for kind, pattern in _KINDS:
        match = pattern.search(bare)
        if match and (kind == "quaternion" or not _QUALITY.search(bare)):
            groups = match.groupdict()
            axis = groups.get("axis") or groups.get("alone") or kind
            stem = _stem(bare, match)
            if kind == "heading" and axis == "heading" and RECEIVERS.search(stem):
                axis = "course"  # a receiver knows where it goes, not where a nose points
            return Meaning(kind, _channel(kind, axis), stem, _sensible(kind, unit))
    if _QUALITY.search(bare):
        return Meaning("quality", bare, "", unit)
    return Meaning(*_by_unit(bare, unit), unit)


def _sensible(kind: str, unit: str) -> str:
    """The unit that is meant: PX4 calls rad/s rad, and G is gravity where it is no field."""
    if kind == "gyro" and unit in ("rad", "deg"):
        return f"{unit}/s"
    return {"gauss": "g", "mgauss": "mg"}.get(unit, unit) if kind == "accelerometer" else unit


def _channel(kind: str, axis: str) -> str:
    if kind == "gyro":
        return _GYRO_AXIS.get(axis, "z" if re.search("rate|vel|speed", axis) else axis)
    return _CHANNEL.get(axis, axis)


def _stem(name: str, match: re.Match[str]) -> str:
    rest = (name[: match.start()].strip("_"), name[match.end() :].strip("_"))
    return "_".join(_STEM.get(part, part) for part in rest if part)


def _by_unit(name: str, unit: str) -> tuple[str, str, str]:
    """Kind, axis and stem of a name like "dvl_x" whose unit says what it measures."""
    match = re.search(rf"_{_AXIS}$", name)
    kind = {"m/s": "velocity", "m/s^2": "accelerometer", "rad/s": "gyro", "deg/s": "gyro", "g": "accelerometer"}.get(
        unit, ""
    )
    if match and kind:
        return kind, _channel(kind, match["axis"]), name[: match.start()]
    return "", name, ""


def _split_unit(column: str) -> tuple[str, str]:
    """The name and the unit that stands in brackets behind it; `q[0]` has an index, not a unit."""
    match = re.search(r"[\[(]([^\[\]()]*)[\])]\s*$", column)
    if match is None or match[1].strip().isdigit():
        return column, ""
    unit = match[1].strip()
    unit = unit if known(unit) else unit[:1].lower() + unit[1:]
    rest = re.sub(r"\([^()]*\)", " ", column[: match.start()])
    return rest, spelled(unit) if known(unit) else ""


def _tokens(name: str) -> list[str]:
    spaced = re.sub(r"([a-z])([A-Z])", r"\1_\2", name)
    return [token for token in re.split(r"[^a-z0-9]+", spaced.lower()) if token]
