"""Options of a fit besides the data: a callback for progress, and a checkpoint file."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path


def _silent(_: str) -> None:
    """No output."""


@dataclass(frozen=True)
class Session:
    """`progress` is called with a few words on the current step.

    `checkpoint`: a file saved after every epoch of a training; resumed if present. Methods without epochs write none.
    """

    progress: Callable[[str], None] = _silent
    checkpoint: Path | None = None


SILENT = Session()
