"""A recipe: a paper's parts by name, and how they are fitted on healthy data."""

from collections.abc import Callable
from dataclasses import dataclass

from sensorfault.logs.table import Log, LogError
from sensorfault.runtime.model import Model
from sensorfault.training.session import Session


@dataclass(frozen=True)
class Recipe:
    """`build(log, seed, session)` fits every part on a healthy log.

    `promise` states the designed false-alarm rate in words, or that there is none. `needs(log)` raises LogError where
    the log lacks what the method takes, as far as that shows without fitting; None: only the fit can tell. `parts`:
    recipes that this one is made of; it runs if one of them does.
    """

    name: str
    title: str
    source: str
    promise: str
    build: Callable[[Log, int, Session], Model]
    needs: Callable[[Log], object] | None = None
    parts: tuple["Recipe", ...] = ()

    def __repr__(self) -> str:
        return f"<Recipe {self.name}: {self.title}>"

    def lacks(self, log: Log) -> str:
        """What keeps the method from running on the log, as far as that shows without fitting; else empty."""
        if self.parts:
            reasons = self.lacking_parts(log)
            return " ".join(reasons.values()) if len(reasons) == len(self.parts) else ""
        if self.needs is not None:
            try:
                self.needs(log)
            except LogError as error:
                return str(error)
        return ""

    def lacking_parts(self, log: Log) -> dict[str, str]:
        """Parts that cannot run on the log, and why."""
        return {part.name: reason for part in self.parts if (reason := part.lacks(log))}
