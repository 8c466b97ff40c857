"""Units that a time column may have."""

PER_SECOND = {"s": 1.0, "ms": 1e3, "us": 1e6, "ns": 1e9, "min": 1 / 60, "h": 1 / 3600}
DAY_ZERO = {"excel": 25_569, "datenum": 719_529}  # what days since 1900, or since the year 0, count at 1970
# What 100 ns count at 1970: of Windows, of .NET, and of those that begin there.
TICK_ZERO = {"filetime": 116_444_736_000_000_000, "ticks": 621_355_968_000_000_000, "unix100ns": 0}
TICKS_PER_SECOND = 10_000_000
JOINED = {
    "s+ms": ("s", "ms"),
    "s+us": ("s", "us"),
    "s+ns": ("s", "ns"),
    "week+s": ("week", "s"),
    "week+ms": ("week", "ms"),
}
ISO = "iso8601"
TIME_WORDS = {
    **dict.fromkeys(("s", "sec", "secs", "second", "seconds"), "s"),
    **dict.fromkeys(("ms", "msec", "millis", "millisecond", "milliseconds"), "ms"),
    **dict.fromkeys(("us", "µs", "μs", "usec", "micros", "microsecond", "microseconds"), "us"),
    **dict.fromkeys(("ns", "nsec", "nanos", "nanosecond", "nanoseconds"), "ns"),
    **dict.fromkeys(("min", "minute", "minutes"), "min"),
    **dict.fromkeys(("h", "hr", "hour", "hours"), "h"),
}
TIME_UNITS = (*PER_SECOND, *DAY_ZERO, *TICK_ZERO, *JOINED, ISO)


def is_time_unit(unit: str) -> bool:
    """Whether it is a unit of time, or a format of dates as strptime has them."""
    return unit in TIME_UNITS or "%" in unit


def is_calendar(unit: str) -> bool:
    """Whether readings in this unit are dates or clocks, written as text."""
    return unit == ISO or "%" in unit


def has_date(unit: str) -> bool:
    """Whether a reading in this unit says which day it is."""
    return unit in (*DAY_ZERO, *TICK_ZERO, ISO) or "%d" in unit or unit.startswith("week")
