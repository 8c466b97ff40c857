"""Paper B: the two-joint arm as printed, then a real arm of six joints."""

from dataclasses import replace

from sensorfault_studies.data import real
from sensorfault_studies.findings import Effort, Findings
from sensorfault_studies.niu1998.drifts import drifts
from sensorfault_studies.niu1998.figures import of_isolation, of_slow_drifts, of_the_run
from sensorfault_studies.niu1998.joints import joints
from sensorfault_studies.niu1998.remarks import remarks
from sensorfault_studies.study import Study

SIMULATED = 0.6  # share of the work


def study(effort: Effort) -> Findings:
    """All of B.

    Raises:
        LogError: the runs of the real arm are not there; said before any work is done.
    """
    real("arm")
    run = drifts(replace(effort, tell=lambda doing, share: effort.tell(doing, SIMULATED * share)))
    arm = joints(replace(effort, tell=lambda doing, share: effort.tell(doing, SIMULATED + (1 - SIMULATED) * share)))
    rows = (*run.rows(), *arm.injected.rows(), *arm.real.rows())
    figures = (*of_the_run(run), *of_slow_drifts(rows), of_isolation(arm.accused))
    return Findings(rows, figures, remarks(run, arm, effort))


STUDY = Study(
    "niu1998",
    "Sensors of a robot arm, and a network that learns while it watches",
    "Niu & Zhao 1998",
    study,
    {"B": "Drifts, and faults of all kinds"},
)
