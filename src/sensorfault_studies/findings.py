"""The result of a study: numbers that a script can check, figures, and remarks."""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import Any

Json = dict[str, Any]
SOURCES = ("real", "injected", "simulated")  # injected: real logs with injected faults


@dataclass(frozen=True)
class Row:
    """One number of a study.

    `condition`: other settings, words joined by spaces. `magnitude`: SI, or channel sigmas with fault `spike`, or
    seconds with `frozen`. `spread`: standard deviation over `seeds` seeds. `paper`: the paper's number.
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
        """For JSON; the keys are the names of the fields."""
        return asdict(self)


@dataclass(frozen=True)
class Figure:
    """Plotly JSON (`data`, `layout`) with a title; `name`: stem of the file, `caption`: what the figure shows."""

    name: str
    title: str
    caption: str
    plot: Json


@dataclass(frozen=True)
class Findings:
    """The results of a study or of one of its experiments."""

    rows: tuple[Row, ...]
    figures: tuple[Figure, ...] = ()
    remarks: tuple[str, ...] = ()

    def __add__(self, other: "Findings") -> "Findings":
        return Findings(self.rows + other.rows, self.figures + other.figures, self.remarks + other.remarks)


@dataclass(frozen=True)
class Effort:
    """How much work a study may do: number of seeds, `quick` for a short run, and a callback for progress (0 to 1)."""

    seeds: int = 5
    quick: bool = False
    progress: Callable[[str, float], None] = lambda doing, share: None
