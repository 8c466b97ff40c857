"""The real logs that the studies run on: never part of the package, found through SENSORFAULT_DATA."""

import os
from pathlib import Path

from sensorfault.logs.table import LogError


def real(folder: str) -> Path:
    """A folder of the real data, as `road/dresden_50hz`.

    Raises:
        LogError: it is not there.
    """
    home = Path(os.environ.get("SENSORFAULT_DATA", "../shared/data"))
    if not (home / folder).exists():
        raise LogError(f"{home / folder}: this study needs these real logs; set SENSORFAULT_DATA to where they lie.")
    return home / folder
