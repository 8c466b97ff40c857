"""What the files of a log and their sensors are called."""

import re
from collections.abc import Sequence
from pathlib import Path

from sensorfault.logs.place import ALIKE
from sensorfault.logs.readers.npy import name_of


def joined(file: str, sensor: str) -> str:
    """A name for a sensor that other files have too."""
    return file if file.endswith(sensor) or f"_{sensor}_" in f"_{file}_" else f"{file}_{sensor}"


def stem_of(path: Path) -> str:
    """A file's name; of arrays, what they measure; the folder's where the file's says nothing."""
    if path.name in ALIKE:
        return path.parent.name
    return name_of(path).split("__")[-1] if path.suffix.lower() == ".npy" else path.stem


def short_names(tables: Sequence[tuple[str, str, str | None]]) -> list[str]:
    """Names of tables (stem, file and table) without what they share and without numbers, where they stay apart."""
    stems = [stem for stem, _, _ in tables]
    apart = (i for i, letters in enumerate(zip(*stems, strict=False)) if len(set(letters)) > 1)
    start = stems[0].rfind("_", 0, next(apart, 0)) + 1
    short = [re.sub(r"\W+", "_", re.sub(r"(_\d+)+$", "", stem[start:])).strip("_").lower() for stem in stems]
    if len(set(short)) == len(short) and all(short):
        return short
    return [re.sub(r"\W+", "_", f"{file}_{table or ''}").strip("_").lower() for _, file, table in tables]
