"""GPS time and Unix time. GPS time runs without leap seconds; Unix time repeats one at each."""

import bisect
from datetime import UTC, datetime

GPS_EPOCH_S = datetime(1980, 1, 6, tzinfo=UTC).timestamp()  # GPS time 0 as Unix time [s]
WEEK_S = 604800.0

# Days from which GPS time is ahead of UTC by 1, 2, 3, ... 18 s (IERS Bulletin C).
_LEAP_DAYS = """
    1981-07-01 1982-07-01 1983-07-01 1985-07-01 1988-01-01 1990-01-01 1991-01-01 1992-07-01 1993-07-01
    1994-07-01 1996-01-01 1997-07-01 1999-01-01 2006-01-01 2009-01-01 2012-07-01 2015-07-01 2017-01-01
"""
_LEAPS = [datetime.fromisoformat(day).replace(tzinfo=UTC).timestamp() for day in _LEAP_DAYS.split()]


def unix_from_gps_calendar(calendar_s: float) -> float:
    """A GPS date and time read as if it were UTC [s since 1970] -> Unix time [s]."""
    return calendar_s - leap_seconds(calendar_s)


def unix_from_gps_week(week: float, time_of_week_s: float) -> float:
    """GPS week (counted on, not modulo 1024) and time of week [s] -> Unix time [s]."""
    return unix_from_gps_calendar(GPS_EPOCH_S + week * WEEK_S + time_of_week_s)


def leap_seconds(calendar_s: float) -> int:
    """GPS time minus UTC [s] on that date."""
    return bisect.bisect_right(_LEAPS, calendar_s)
