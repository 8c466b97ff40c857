"""The recall table: fault kind x channel x magnitude."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sensorfault.evaluation.judge import GRACE_S, Outcome, covered_s
from sensorfault.faults.fault import KINDS
from sensorfault.runtime.result import Detection


@dataclass(frozen=True)
class Cell:
    """One row of the recall table: all faults of one kind, channel and magnitude.

    `recall`: share of the faults that were detected. `chance`: probability of an alarm in an equally long window
    without a fault. `false_isolations`: events on healthy channels, a fault. `recovery`: median of repaired over
    measured error, below 1 where the stand-in is better than the faulty value.
    """

    kind: str
    channel: str
    magnitude: float
    faults: int
    recall: float
    chance: float
    delay_p50_s: float
    delay_p95_s: float
    sensor_right: float
    channel_right: float
    kind_right: float
    false_isolations: float
    recovery: float


def tabulate(outcomes: Sequence[Outcome], clean: Detection) -> tuple[Cell, ...]:
    """Outcomes by kind, magnitude and channel; `clean`: the same model on the same log without faults."""
    groups: dict[tuple[str, float, str], list[Outcome]] = {}
    for outcome in outcomes:
        fault = outcome.fault
        where = f"{fault.sensor}.{fault.channel}" if fault.channel else fault.sensor
        groups.setdefault((fault.kind, fault.magnitude, where), []).append(outcome)
    in_order = sorted(groups, key=lambda key: (KINDS.index(key[0]), key[1], key[2]))
    return tuple(_cell(kind, where, size, groups[kind, size, where], clean) for kind, size, where in in_order)


def _cell(kind: str, where: str, magnitude: float, group: list[Outcome], clean: Detection) -> Cell:
    found = [outcome for outcome in group if outcome.found]
    delays = [outcome.delay_s for outcome in found]
    ratios = [o.error_after / o.error_before for o in group if o.error_before > 0 and np.isfinite(o.error_after)]
    window = float(np.mean([outcome.fault.duration_s for outcome in group])) + GRACE_S
    alarming = covered_s([(event.start_s - window, event.start_s) for event in clean.events])
    return Cell(
        kind=kind,
        channel=where,
        magnitude=magnitude,
        faults=len(group),
        recall=len(found) / len(group),
        chance=min(1.0, alarming / clean.log.duration_s),
        delay_p50_s=float(np.median(delays)) if delays else float("nan"),
        delay_p95_s=float(np.percentile(delays, 95)) if delays else float("nan"),
        sensor_right=_share([outcome.sensor_right for outcome in found]),
        channel_right=_share([outcome.channel_right for outcome in found]),
        kind_right=_share([outcome.kind_right for outcome in found]),
        false_isolations=float(np.mean([outcome.false_isolations for outcome in group])),
        recovery=float(np.median(ratios)) if ratios else float("nan"),
    )


def _share(right: list[bool]) -> float:
    return sum(right) / len(right) if right else float("nan")
