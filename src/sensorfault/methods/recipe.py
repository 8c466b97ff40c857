"""A recipe: the parts of one method, its source, and how the parts are fitted on healthy data."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from sensorfault.logs.table import Log, LogError
from sensorfault.training.session import Session

if TYPE_CHECKING:
    from sensorfault.runtime.model import Model


@dataclass(frozen=True)
class Recipe:
    """`build(log, seed, session)` fits every part on a healthy log.

    `false_alarm_rate` states in words the rate the limits are designed for, or that there is none. `needs(name,
    log)` raises LogError where the log lacks a required channel, as far as this shows without fitting; None: only the
    fit shows it.
    `parts`: the recipes that a composite consists of; it runs if at least one of them does.
    """

    name: str
    title: str
    source: str
    false_alarm_rate: str
    build: Callable[[Log, int, Session], "Model"]
    needs: Callable[[str, Log], object] | None = None
    parts: tuple["Recipe", ...] = ()

    def __repr__(self) -> str:
        return f"<Recipe {self.name}: {self.title}>"

    def lacks(self, log: Log) -> str:
        """Why the method cannot run on the log, as far as this shows without fitting; empty if it can."""
        if self.parts:
            reasons = self.lacking_parts(log)
            return " ".join(reasons.values()) if len(reasons) == len(self.parts) else ""
        if self.needs is not None:
            try:
                self.needs(self.name, log)
            except LogError as error:
                return str(error)
        return ""

    def lacking_parts(self, log: Log) -> dict[str, str]:
        """Parts that cannot run on the log, and why."""
        return {part.name: reason for part in self.parts if (reason := part.lacks(log))}
