"""NMEA sentences."""

from pathlib import Path

from pynmeagps import GET, NMEAMessage


def nmea(folder: Path) -> Path:
    """A dozen seconds of GGA and RMC, in pynmeagps' own words."""
    path = folder / "rover.nmea"
    place = {"NS": "N", "EW": "E"}
    said = []
    for k in range(12):
        now = {"time": f"12:00:{k:02}", "lat": 48.1 + 1e-5 * k, "lon": 11.6, **place}
        said += [
            NMEAMessage("GN", "GGA", GET, **now, quality=4, numSV=12, HDOP=0.6, alt=512.3, altUnit="M"),
            NMEAMessage("GN", "RMC", GET, **now, status="A", spd=3.6, cog=90.0, date="2025-08-24"),
        ]
    path.write_bytes(b"".join(one.serialize() for one in said))
    return path


SMALL = {"NMEA": nmea}
