"""Autopilots: which of the many messages in their logs say what of which sensor."""

from collections.abc import Collection

from sensorfault.logs.guess.autopilots.ardupilot import ARDUPILOT
from sensorfault.logs.guess.autopilots.mavlink import MAVLINK
from sensorfault.logs.guess.autopilots.px4 import PX4
from sensorfault.logs.guess.autopilots.stock import Stock

__all__ = ["PX4", "Stock", "recognised"]


def recognised(tables: Collection[str]) -> Stock | None:
    """The autopilot whose tables these are; a table without a name is nobody's."""
    return next((one for one in (PX4, ARDUPILOT, MAVLINK) if one.tells & set(tables)), None)
