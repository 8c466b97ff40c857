"""Names of time columns, and the units that they say."""

import re

from sensorfault.logs.guess.words import read_name
from sensorfault.logs.time_units import TIME_WORDS

_WORDS = (
    ("ms", r"millis|msec|(^|_)ms$"),
    ("us", r"micros|usec|(^|_)us$"),
    ("ns", r"nanos|nsec|(^|_)ns$"),
    ("s", r"(^|_)(s|secs?|seconds?)(_|$)"),
)
_FOREIGN = r"ts|date_?num|zeit|uhrzeit|datum|zeitstempel|heure|horodatage|fecha|hora|tijd|ora|orario"
_ALSO = re.compile(rf"(^|_)({_FOREIGN})(_|$)")
_PLAIN = re.compile(
    rf"((utc|gps|local|device|system|log|sample|recording)_?)?(t|time|date|clock|stamp|time_?stamp|date_?time|{_FOREIGN})"
    r"(_?(utc|gps|local|of_day))?(_(s|ms|us|ns|sec|secs|seconds))?"
)


def is_named(name: str) -> bool:
    """Whether a name speaks of time."""
    return read_name(name).kind == "time" or _ALSO.search(bare(name)) is not None


def is_plain(name: str) -> bool:
    """Whether a name is that of the clock, and of nothing else."""
    return _PLAIN.fullmatch(bare(name)) is not None


def unit_by_bracket(name: str) -> str | None:
    """The unit in brackets behind a name."""
    bracket = re.search(r"[\[(]([^\[\]()]*)[\])]\s*$", name)
    return None if bracket is None else TIME_WORDS.get(bracket[1].strip())


def unit_by_word(name: str) -> str | None:
    """The unit that a name ends with."""
    lower = bare(name)
    return next((unit for unit, pattern in _WORDS if re.search(pattern, lower)), None)


def bare(name: str) -> str:
    """Its words in lower case with `_` between, without what stands in brackets."""
    plain = re.sub(r"[\[(][^\[\]()]*[\])]", " ", name)
    spaced = re.sub(r"([a-z])([A-Z])", r"\1_\2", plain)
    return "_".join(re.findall(r"[^\W_]+", spaced.lower()))
