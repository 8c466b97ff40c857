"""Seconds of a log as a person reads them."""


def clock(seconds: float) -> str:
    """[s] -> `m:ss.cc`, from an hour on `h:mm:ss.cc`."""
    minutes, hundredths = divmod(round(abs(seconds) * 100), 6000)
    hours, minutes = divmod(minutes, 60)
    rest = f"{hundredths / 100:05.2f}"
    text = f"{hours}:{minutes:02d}:{rest}" if hours else f"{minutes}:{rest}"
    return f"-{text}" if seconds < 0 else text
