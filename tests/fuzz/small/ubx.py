"""u-blox receivers' own protocol."""

from pathlib import Path

from pyubx2 import GET, UBXMessage

from logs import written_subframes


def ubx(folder: Path) -> Path:
    """Twelve epochs of three satellites and as many fixes, in pyubx2's own words."""
    path = folder / "rover.ubx"
    path.write_bytes(b"".join(_raw(k).serialize() + _fix(k).serialize() for k in range(12)))
    return path


def _raw(k: int) -> UBXMessage:
    result: dict[str, float] = {"rcvTow": 1000.0 + k, "week": 2381, "leapS": 18, "numMeas": 3}
    for i, satellite in enumerate((7, 12, 30), 1):
        result |= {
            f"prMes_{i:02}": 2.1e7 + 100.5 * k + i,
            f"doMes_{i:02}": -500.25,
            f"gnssId_{i:02}": 0,
            f"svId_{i:02}": satellite,
            f"cno_{i:02}": 40 + i,
            f"prStd_{i:02}": 5,
            f"prValid_{i:02}": 1,
        }
    return UBXMessage("RXM", "RXM-RAWX", GET, **result)


def _fix(k: int) -> UBXMessage:
    when = {"year": 2025, "month": 8, "day": 24, "hour": 0, "min": 16, "second": 22 + k, "nano": 250_000_000}
    valid = {"validDate": 1, "validTime": 1, "gnssFixOk": 1, "fixType": 3}
    return UBXMessage(
        "NAV", "NAV-PVT", GET, **when, **valid, lat=48.1 + 1e-5 * k, lon=-11.6, height=512_345, velN=1500, velE=-20 * k
    )


SMALL = {
    "u-blox": ubx,
    "u-blox, with ephemerides": lambda folder: written_subframes.rover(folder / "rover.ubx"),
}
