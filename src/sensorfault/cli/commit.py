"""Which version of the code a study ran on."""

import subprocess
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

_DESCRIBE = ("git", "describe", "--always", "--abbrev=40", "--exclude=*", "--dirty")


def commit(checkout: Path | None = None) -> str:
    """The checkout's commit, `-dirty` behind it where files differ from it; without a checkout or git, the version.

    Args:
        checkout: by default the one that this file lies in, if it is one.
    """
    home = checkout or Path(__file__).parents[3]
    if (home / ".git").exists():
        try:
            done = subprocess.run(_DESCRIBE, cwd=home, capture_output=True, text=True, timeout=10, check=True)
        except (OSError, subprocess.SubprocessError):
            return _version()
        return done.stdout.strip() or _version()
    return _version()


def _version() -> str:
    try:
        return version("sensorfault")
    except PackageNotFoundError:
        return "unknown"
