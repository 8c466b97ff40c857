"""What a study says: numbers that a script can check, figures, and sentences for what numbers do not say."""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

Json = dict[str, Any]
SOURCES = ("real", "injected", "simulated")  # injected: real logs with injected faults


@dataclass(frozen=True)
class Row:
    """One number of a study.

    `condition`: what else was fixed, words joined by spaces. `magnitude`: SI, or channel sigmas with fault `short`, or
    seconds with `jam`. `spread`: standard deviation over `seeds` seeds. `paper`: what the paper prints for it.
    """

    experiment: str
    data: str
    source: str
    condition: str
    method: str
    fault: str | None
    magnitude: float | None
    metric: str
    value: float
    spread: float | None = None
    seeds: int = 1
    paper: float | None = None

    def as_dict(self) -> Json:
        """For JSON; the keys are the fields."""
        return asdict(self)


@dataclass(frozen=True)
class Figure:
    """Plotly JSON (`data`, `layout`) under a title; `name` is the file's stem, `caption` says what to see."""

    name: str
    title: str
    caption: str
    plot: Json


@dataclass(frozen=True)
class Findings:
    """The findings of a study or of one of its experiments."""

    rows: tuple[Row, ...]
    figures: tuple[Figure, ...] = ()
    remarks: tuple[str, ...] = ()

    def __add__(self, other: "Findings") -> "Findings":
        return Findings(self.rows + other.rows, self.figures + other.figures, self.remarks + other.remarks)


@dataclass(frozen=True)
class Effort:
    """How much work a study may do: number of seeds, `quick` for a look, and whom to tell of the progress (0 to 1)."""

    seeds: int = 5
    quick: bool = False
    tell: Callable[[str, float], None] = lambda doing, share: None
