"""Ranges of real beacons: radio among pedestrians, sound under water, barcodes on a floor."""

import numpy as np
from jaxtyping import Bool

from sensorfault_studies.findings import Effort, Findings
from sensorfault_studies.numbers import Numbers
from sensorfault_studies.xu2023 import receivers, robots, walks
from sensorfault_studies.xu2023.gates import FITTED, MATCHED, Watched, compared, following, innovation_sd, matching
from sensorfault_studies.xu2023.ranging_remarks import of_dive, of_robots, of_walks
from sensorfault_studies.xu2023.rovers import METHODS, struck, watched
from sensorfault_studies.xu2023.run import through

ROWS = 256  # the number of rows is rounded up to a multiple of this, to save compilations


def findings(effort: Effort) -> Findings:
    """All three data sets.

    Raises:
        LogError: one of them is not there.
    """
    made = []
    for k, (doing, one) in enumerate((("walkers", _walks), ("a dive", _dive), ("robots", _robots))):
        effort.progress(f"real ranges: {doing}", k / 3)
        made.append(one(effort))
    return sum(made[1:], made[0])


def _walks(effort: Effort) -> Findings:
    """All walks; with `quick` the first of each trajectory."""
    numbers = Numbers("E-ranging", "uwb_outdoor", "real")
    every = [
        following(f"walk-{walk.name}", walks.scenario(walk)) for walk in walks.walks()[:: 2 if effort.quick else 1]
    ]
    compared(numbers, FITTED, every, dict.fromkeys(every[0].monitors, 1.0), _rows(every))
    return Findings(tuple(numbers.rows()), (), (of_walks(numbers, every),))


def _robots(effort: Effort) -> Findings:
    """Five robots; with `quick` two."""
    every = [watched(robot) for robot in robots.ROBOTS[: 2 if effort.quick else None]]
    gated = [method for method in METHODS if not method.startswith("ungated")]
    factors = {method: matching(method, every, _rows(every)) for method in gated}
    real, injected = Numbers("E-ranging", "mrclam", "real"), Numbers("E-ranging", "mrclam", "injected")
    compared(real, FITTED, every, dict.fromkeys(METHODS, 1.0), _rows(every))
    compared(real, MATCHED, every, factors, _rows(every))
    faulty = [struck(one, seed=1) for one in every]
    compared(injected, MATCHED, faulty, {"ungated-ackf": 1.0} | factors, _rows(every))
    rows = (*real.rows(), *injected.rows())
    return Findings(rows, (), (of_robots(real, injected),))


def _dive(effort: Effort) -> Findings:
    """No truth: which ranges are rejected, by group of the file's own quality values."""
    of = receivers.dive()
    places = receivers.placed(of)
    one = following("dive", receivers.scenario(of, places))
    later = np.isfinite(of.range) & one.case.judged[:, None]
    weak, strong = np.quantile(of.signal[later], (1 / 3, 2 / 3))
    groups = {
        "": later,
        "impossible": later & receivers.impossible(of, places),
        "weak-third": later & (of.signal < weak),
        "strong-third": later & (of.signal >= strong),
        "unsolved": later & ~of.solved[:, None],
    }
    numbers = Numbers("E-ranging", "ugps_g2", "real")
    for method, monitor in one.monitors.items():
        run = through(monitor, one.case)
        numbers.add(FITTED, method, {"innovation_sd": innovation_sd(run, one.case)})
        if not method.startswith("ungated"):
            for words, group in groups.items():
                numbers.add(f"{words} {FITTED}".strip(), method, _refused(run.flagged, group))
    return Findings(tuple(numbers.rows()), (), (of_dive(numbers, groups),))


def _refused(flagged: Bool[np.ndarray, "T L"], group: Bool[np.ndarray, "T L"]) -> dict[str, float]:
    return {"rejected_fraction": float(flagged[group].mean()) if group.any() else float("nan")}


def _rows(every: list[Watched]) -> int:
    return -(-max(len(one.case.log) for one in every) // ROWS) * ROWS
