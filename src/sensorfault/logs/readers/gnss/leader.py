"""The file that stands for an observation file and the orbits beside it."""

from pathlib import Path

from sensorfault.logs.readers.gnss.rinex import looks_rinex


def observations_beside(path: Path) -> Path:
    """The first RINEX observation file in the folder of a file of orbits; the file itself if there is none."""
    for file in sorted(path.parent.iterdir()):
        if file != path and file.is_file():
            with file.open("rb") as opened:
                if looks_rinex("O", opened.read(96)):
                    return file
    return path
