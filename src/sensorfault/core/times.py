"""Times as people read them."""

import math


def clock(seconds: float) -> str:
    """Seconds [s] as m:ss.ss, from one hour on as h:mm:ss.ss; "unknown" where there is no time.

    >>> clock(62.5), clock(4500.0), clock(-49.65)
    ('1:02.50', '1:15:00.00', '-0:49.65')
    """
    if not math.isfinite(seconds):
        return "unknown"
    hundredths = round(abs(seconds) * 100)
    minutes, rest = divmod(hundredths, 6000)
    hours, minutes = divmod(minutes, 60)
    text = f"{hours}:{minutes:02d}:{rest / 100:05.2f}" if hours else f"{minutes}:{rest / 100:05.2f}"
    return f"-{text}" if seconds < 0 and hundredths else text
