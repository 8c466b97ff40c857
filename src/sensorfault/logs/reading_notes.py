"""What reading a log found; needs no reader."""

from dataclasses import dataclass


@dataclass(frozen=True)
class ReadingNotes:
    """Sentences on a log that was read.

    `damage`: where a file could not be read. `notes`: that, and what else reading found.
    """

    notes: tuple[str, ...]
    damage: tuple[str, ...]
