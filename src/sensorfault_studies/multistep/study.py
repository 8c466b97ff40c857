"""Paper D: ramps on a height, observed over 1 to 15 steps on two real flights; slow drift by the minute; who drifts."""

from collections.abc import Iterator
from dataclasses import replace

from sensorfault_studies.data import real
from sensorfault_studies.findings import Effort, Findings, Row
from sensorfault_studies.multistep import slow_page, who
from sensorfault_studies.multistep.contenders import NETWORK
from sensorfault_studies.multistep.drift import PRINTED, Drift, drifts
from sensorfault_studies.multistep.figures import SLOW, of_drift
from sensorfault_studies.multistep.remarks import remarks
from sensorfault_studies.study import Study

STEPPED = 0.8  # share of the work
PAPER = {  # of the mean over all slopes, and of figure 7; delays from the onset at step 500
    ("N1", None): {"detection_rate": 0.334, "delay_steps": 134.0},
    ("N12", None): {"detection_rate": 0.655, "delay_steps": 16.0},
    ("N1", SLOW): {"delay_steps": 383.0},
    ("N10", SLOW): {"delay_steps": 80.0},
}


def study(effort: Effort) -> Findings:
    """All of D.

    Raises:
        LogError: a flight is not there; said before any work is done.
    """
    real("uav")
    result = drifts(replace(effort, tell=lambda doing, share: effort.tell(doing, STEPPED * share)))
    rows = tuple(row for one in result for row in rows_of(one))
    figures = tuple(figure for one in result for figure in of_drift(one))
    over_steps = Findings(rows, figures, remarks(result))
    by_the_minute = replace(effort, tell=lambda doing, share: effort.tell(doing, STEPPED + (1 - STEPPED) * share))
    return over_steps + slow_page.findings(by_the_minute) + who.findings(by_the_minute)


def rows_of(result: Drift) -> Iterator[Row]:
    """With the paper's numbers beside its own method under its own threshold."""
    yield from result.real.rows()
    for row in result.injected.rows():
        own = row.method == NETWORK and row.condition.startswith(PRINTED)
        paper = PAPER.get((row.condition.split()[-1], row.magnitude), {}) if own else {}
        yield replace(row, paper=paper.get(row.metric))


STUDY = Study(
    "multistep",
    "Incipient drift of an aircraft's height, seen by an observer of many steps",
    "Wang S. et al.",
    study,
    {
        "D": "Ramps, observed over N steps",
        "D-slow": "Slow drift against a barometer, over a minute or more",
        "D-who": "Who is accused when a height drifts",
    },
)
