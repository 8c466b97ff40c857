"""One value a seed of every number, until they become rows."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from sensorfault_studies.findings import Row


class Key(NamedTuple):
    """What a number is of; see Row."""

    condition: str
    method: str
    fault: str | None
    magnitude: float | None
    metric: str


@dataclass
class Numbers:
    """Of one experiment on one kind of data."""

    experiment: str
    data: str
    source: str
    values: dict[Key, list[float]] = field(default_factory=dict)

    def add(
        self,
        condition: str,
        method: str,
        result: Mapping[str, float],
        fault: str | None = None,
        size: float | None = None,
    ) -> None:
        """One more seed's numbers, by metric."""
        for metric, value in result.items():
            self.values.setdefault(Key(condition, method, fault, size, metric), []).append(float(value))

    def mean(
        self, condition: str, method: str, metric: str, fault: str | None = None, size: float | None = None
    ) -> float:
        """Over the seeds; NaN for what was not measured."""
        found = self.values.get(Key(condition, method, fault, size, metric), [])
        return float(np.mean(found)) if found else float("nan")

    def rows(self, paper: Mapping[str, float] = {}) -> Iterator[Row]:
        """Mean and spread; `paper`: what the paper prints for a metric."""
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
