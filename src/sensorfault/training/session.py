"""What a fit may do besides fitting: say how far it is, and leave a checkpoint to go on from."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path


def _silent(_: str) -> None:
    """Nobody listens."""


@dataclass(frozen=True)
class Session:
    """`progress` is called with a few words on the current step. `checkpoint`: written while a network is trained by
    epochs, and gone on from if it is there; a method that is fitted in one stroke writes none.
    """

    progress: Callable[[str], None] = _silent
    checkpoint: Path | None = None


SILENT = Session()
