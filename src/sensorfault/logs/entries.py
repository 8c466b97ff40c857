"""The entries of a vehicle file: channels, sensors, files. `why`: the reason of a guess, written as a comment."""

from dataclasses import dataclass, field


@dataclass(frozen=True)
class ChannelEntry:
    """One column that is a channel. `missing`: the number that means no value. `watch`: whether it may be judged.

    `valid`: a condition on another column, as `fix_type >= 2`; where it does not hold there is no value. `kind`: one
    of KINDS.
    """

    name: str
    column: str
    unit: str = ""
    missing: float | None = None
    epoch: str | None = None
    watch: bool = True
    valid: str | None = None
    kind: str = ""
    why: str = field(default="", compare=False)


@dataclass(frozen=True)
class SensorEntry:
    """One sensor and the file it is in. `why` (here and elsewhere): the reason of a guess, written as a comment."""

    name: str
    channels: tuple[ChannelEntry, ...]
    file: str = "log"
    held: bool = False
    epoch: str | None = None
    period_s: float | None = None
    why: str = field(default="", compare=False)


@dataclass(frozen=True)
class FileEntry:
    """One file, or one `table` of a file that holds several, and its clock.

    `fine`: a second column that goes on where the first ends, as the clock beside a date. `rate_hz`: rows a second of a
    file without a clock; it has no `time` then. `doubt`: another way to read its time that
    is as good as the one taken.
    """

    name: str = "log"
    path: str | None = None
    time: str | None = None
    unit: str = "s"
    offset_s: float = 0.0
    tag: str | None = None
    table: str | None = None
    fine: str | None = None
    rate_hz: float | None = None
    why: str = field(default="", compare=False)
    doubt: str = field(default="", compare=False)
    left_out: tuple[tuple[str, str], ...] = field(default=(), compare=False)
