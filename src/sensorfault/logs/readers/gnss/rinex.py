"""What RINEX files of all kinds share: lines and a header whose labels stand in column 61.

Source: RINEX 2.11 (Gurtner, 2007) and RINEX 3.04 (IGS/RTCM, 2018), section 4 and table A2.
"""

import calendar
from dataclasses import dataclass, replace
from datetime import MAXYEAR
from pathlib import Path

import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import LogError

_LABEL = 60
_KINDS = "ONGM"


@dataclass(frozen=True)
class Header:
    """`kind`: O observations, N ephemerides, G GLONASS ephemerides of version 2. `lines`: how many it takes.

    `codes`: what each system's columns are; version 2 has one list for all, under "". `behind_s`: GPS time minus the
    time that the rows are in [s].
    """

    version: float
    kind: str
    lines: int
    codes: dict[str, tuple[str, ...]]
    klobuchar: Float[np.ndarray, "8"] | None
    behind_s: float = 0.0


def lines_of(path: Path) -> list[str]:
    """The lines of a text file, whatever bytes are in it."""
    return path.read_bytes().decode("ascii", "replace").splitlines()


def looks_rinex(kinds: str, head: bytes) -> bool:
    """Whether a file that begins so is a RINEX file of one of these kinds."""
    line = head[:81].decode("ascii", "replace")
    return line[_LABEL:].startswith("RINEX VERSION / TYPE") and line[20:21] in kinds


def read_header(path: Path, lines: list[str]) -> Header:
    """The header.

    Raises:
        LogError: the file is no RINEX file of version 2 or 3, or its header does not end.
    """
    first = lines[0] if lines else ""
    try:
        header = Header(float(first[:9]), first[20:21], 0, {}, None)
    except ValueError:
        header = Header(0.0, "", 0, {}, None)
    if (
        not first[_LABEL:].startswith("RINEX VERSION")
        or header.kind not in tuple(_KINDS)
        or not 2 <= header.version < 4
    ):
        raise LogError(f"{path}: by its first line this is not a RINEX file of version 2 or 3; convert the log again.")
    alpha, beta, system = np.zeros(4), np.zeros(4), ""
    codes: dict[str, list[str]] = {}
    for number, line in enumerate(lines, 1):
        label, text = line[_LABEL:].strip(), line[:_LABEL]
        try:
            if label == "END OF HEADER":
                result = np.concatenate((alpha, beta))
                return replace(
                    header,
                    lines=number,
                    codes={name: tuple(each) for name, each in codes.items()},
                    klobuchar=result if result.any() else None,
                )
            if label == "ION ALPHA":
                alpha = _four(text, 2)
            elif label == "ION BETA":
                beta = _four(text, 2)
            elif label == "IONOSPHERIC CORR" and text.startswith("GPSA"):
                alpha = _four(text, 5)
            elif label == "IONOSPHERIC CORR" and text.startswith("GPSB"):
                beta = _four(text, 5)
            elif label == "# / TYPES OF OBSERV":
                codes.setdefault("", []).extend(text[6:].split())
            elif label == "SYS / # / OBS TYPES":
                system = text[:1].strip() or system
                codes.setdefault(system, []).extend(text[6:].split())
            elif label == "TIME OF FIRST OBS":
                header = replace(header, behind_s=_behind(text))
        except ValueError:
            raise LogError(f"{path}: line {number} of the header cannot be read; convert the log again.") from None
    raise LogError(f"{path}: the header does not end (no line END OF HEADER); convert the log again.")


def _four(text: str, start: int) -> Float[np.ndarray, "4"]:
    return np.array([float(text[start + 12 * i : start + 12 * i + 12].replace("D", "E")) for i in range(4)])


def _behind(text: str) -> float:
    """Of the time system that the first observation's line names: BeiDou's is 14 s behind GPS time."""
    return 14.0 if text[48:51] == "BDT" else 0.0


def calendar_s(fields: list[str]) -> float:
    """Year, month, day, hour, minute and second as if UTC -> seconds since 1970.

    Raises:
        ValueError: they are no date and time.
    """
    year, month, day, hour, minute = (int(field) for field in fields[:5])
    second = float(fields[5])
    if not (1 <= month <= 12 and 1 <= day <= 31 and 0 <= hour < 24 and 0 <= minute < 60 and 0 <= second < 61):
        raise ValueError("no date and time")
    full = year if year >= 100 else year + (2000 if year < 80 else 1900)
    if full > MAXYEAR:
        raise ValueError("no year")
    return float(calendar.timegm((full, month, day, hour, minute, 0))) + second
