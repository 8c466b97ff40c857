"""ArduPilot's logs, and its telemetry."""

from fuzz.writing import bytes_file, text_file
from logs import written_ardupilot, written_dataflash

SMALL = {
    "ArduPilot DataFlash": bytes_file("flight.bin", lambda: written_dataflash.flight(seconds=2.0)),
    "ArduPilot DataFlash text": text_file("flight.log", lambda: written_ardupilot.text(1.0)),
    "MAVLink telemetry": bytes_file("flight.tlog", lambda: written_ardupilot.tlog(1.0)),
}
