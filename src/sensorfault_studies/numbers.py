"""Collects one value for each seed of every number, and makes rows of them."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from sensorfault_studies.findings import Row


class Key(NamedTuple):
    """The key of a number; see Row."""

    condition: str
    method: str
    fault: str | None
    magnitude: float | None
    metric: str


@dataclass
class Numbers:
    """The numbers of one experiment on one kind of data."""

    experiment: str
    data: str
    source: str
    values: dict[Key, list[float]] = field(default_factory=dict)

    def add(
        self,
        condition: str,
        method: str,
        measured: Mapping[str, float],
        fault: str | None = None,
        size: float | None = None,
    ) -> None:
        """Add the numbers of one more seed, by metric."""
        for metric, value in measured.items():
            self.values.setdefault(Key(condition, method, fault, size, metric), []).append(float(value))

    def mean(
        self, condition: str, method: str, metric: str, fault: str | None = None, size: float | None = None
    ) -> float:
        """Mean over the seeds; NaN if not measured."""
        found = self.values.get(Key(condition, method, fault, size, metric), [])
        return float(np.mean(found)) if found else float("nan")

    def rows(self, paper: Mapping[str, float] = {}) -> Iterator[Row]:
        """Mean and spread as rows; `paper`: metric -> the paper's number."""
        for (condition, method, fault, size, metric), values in self.values.items():
            spread = float(np.std(values, ddof=1)) if len(values) > 1 else None
            yield Row(
                experiment=self.experiment,
                data=self.data,
                source=self.source,
                condition=condition,
                method=method,
                fault=fault,
                magnitude=size,
                metric=metric,
                value=float(np.mean(values)),
                spread=spread,
                seeds=len(values),
                paper=paper.get(metric),
            )
