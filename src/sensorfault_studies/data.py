"""The real logs of the studies. They are not part of the package; SENSORFAULT_DATA says where they are."""

import os
from pathlib import Path

from sensorfault.logs.table import LogError


def real(folder: str) -> Path:
    """A folder of the real data, for example `road/dresden_50hz`.

    Raises:
        LogError: the folder does not exist.
    """
    home = Path(os.environ.get("SENSORFAULT_DATA", "../shared/data"))
    if not (home / folder).exists():
        raise LogError(f"{home / folder}: this study needs these real logs; set SENSORFAULT_DATA to their folder.")
    return home / folder
