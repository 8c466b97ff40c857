"""A recipe: a paper's parts by name, and how they are fitted on healthy data."""

from collections.abc import Callable
from dataclasses import dataclass

from sensorfault.logs.table import Log
from sensorfault.model import Model
from sensorfault.training.session import Session


@dataclass(frozen=True)
class Recipe:
    """`build(log, seed, session)` fits every part on a healthy log.

    `promise` states the designed false-alarm rate in words, or that there is none.
    """

    name: str
    title: str
    source: str
    promise: str
    build: Callable[[Log, int, Session], Model]
