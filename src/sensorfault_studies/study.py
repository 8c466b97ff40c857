"""What a study is, and its findings as the command line shows them."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from sensorfault_studies.findings import Effort, Findings, Json
from sensorfault_studies.page import page
from sensorfault_studies.tables import Cell, grouped, tables, thinned, titled


class Printed(NamedTuple):
    """A table as text. `numbers`: the columns that hold numbers."""

    heading: str
    columns: tuple[str, ...]
    rows: list[tuple[str, ...]]
    numbers: tuple[str, ...]


@dataclass(frozen=True)
class Study:
    """The experiments of one paper.

    `run`: does them all. `experiments`: the title of each, by the code that `Row.experiment` has.
    """

    name: str
    title: str
    paper: str
    run: Callable[[Effort], Findings]
    experiments: Mapping[str, str]

    def reproduce(self, seeds: int, quick: bool, tell: Callable[[str, float], None]) -> "Reproduction":
        """Run the experiments.

        Args:
            seeds: how many runs that differ by chance.
            quick: less of everything, for a look.
            tell: is called with what is being done and the share that is done, 0 to 1.

        Raises:
            LogError: a real log that the study needs is not there.
        """
        return Reproduction(self, self.run(Effort(seeds, quick, tell)))


@dataclass(frozen=True)
class Reproduction:
    """A study and its findings."""

    study: Study
    findings: Findings

    @property
    def remarks(self) -> tuple[str, ...]:
        """Sentences for what numbers do not say."""
        return self.findings.remarks

    def records(self) -> list[Json]:
        """Every number as a dict for JSON."""
        return [row.as_dict() for row in self.findings.rows]

    def tables(self) -> Iterator[Printed]:
        """Every number, in tables for people."""
        for code, rows in grouped(self.findings.rows, lambda row: row.experiment):
            title = titled(self.study.experiments, code)
            for table in tables(rows):
                labels = thinned([labels for labels, _ in table.rows])
                lines = [(*left, *map(_text, cells)) for left, (_, cells) in zip(labels, table.rows, strict=True)]
                heading = " · ".join(part for part in (title, table.title, table.source) if part)
                yield Printed(heading, (*table.labels, *table.heads), lines, table.heads)

    def page(self, facts: str) -> str:
        """One HTML file as text; `facts`: commit and effort in one line."""
        return page(f"{self.study.paper}: {self.study.title}", self.study.experiments, self.findings, facts)


def _text(cell: Cell) -> str:
    return f"{cell.value} {cell.spread}".strip()
