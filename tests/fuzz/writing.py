"""What the small files share: their length, the columns of tables, and how a file is written."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

EPOCHS = 12
TIME = np.arange(60) / 10
COLUMNS = {"t": TIME, "ax": np.sin(TIME), "ay": np.cos(TIME), "az": 9.8 + 0.1 * np.sin(3 * TIME)}


def text_file(name: str, content: Callable[[], str]) -> Callable[[Path], Path]:
    """Write this text to a file of this name in a folder."""
    return bytes_file(name, lambda: content().encode())


def bytes_file(name: str, content: Callable[[], bytes]) -> Callable[[Path], Path]:
    """The same with bytes."""

    def write(folder: Path) -> Path:
        path = folder / name
        path.write_bytes(content())
        return path

    return write
