"""Of files that are one log with observations, the one that stands for them."""

from pathlib import Path

from sensorfault.logs.readers.gnss.rinex import looks_rinex


def observations_beside(path: Path) -> Path:
    """The first RINEX observation file in the folder of a file that tells where satellites are; else itself."""
    for file in sorted(path.parent.iterdir()):
        if file != path and file.is_file():
            with file.open("rb") as opened:
                if looks_rinex("O", opened.read(96)):
                    return file
    return path
