"""PX4's logs."""

from fuzz.writing import bytes_file
from logs import written_ulog

SMALL = {"PX4 ULog": bytes_file("flight.ulg", lambda: written_ulog.flight(1.0))}
