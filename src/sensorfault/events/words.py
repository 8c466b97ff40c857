"""Whom an event accuses, in words."""

from sensorfault.events.event import Event

MOTION = "vehicle motion"
WHOLE_LOG = "the whole log"  # nothing was recorded
UNKNOWN = "unknown which"  # no sensor could be isolated


def accused(event: Event) -> str:
    """The sensor's name, or one of MOTION, WHOLE_LOG, UNKNOWN."""
    if event.subject == "motion":
        return MOTION
    return event.sensor or (WHOLE_LOG if event.kind == "missing" else UNKNOWN)


def accused_path(event: Event) -> str:
    """`gnss.altitude` or `gnss`, or one of MOTION, WHOLE_LOG, UNKNOWN."""
    return f"{event.sensor}.{event.channel}" if event.sensor and event.channel else accused(event)
