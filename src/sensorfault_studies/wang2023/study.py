"""Paper C: a train's satellites that lie, told by innovations, by local outlier factors, and by leaving one out."""

from dataclasses import replace

from sensorfault_studies.data import real
from sensorfault_studies.findings import Effort, Findings
from sensorfault_studies.numbers import Numbers
from sensorfault_studies.study import Study
from sensorfault_studies.wang2023 import drive, nlos, smartloc, walk
from sensorfault_studies.wang2023.drives import CONDITIONS, DATA, EXPERIMENT, judged
from sensorfault_studies.wang2023.remarks import of_drives, of_rides
from sensorfault_studies.wang2023.rides import rides
from sensorfault_studies.wang2023.sweeps import sweeps

DRIVES = 0.8  # share of the work


def study(effort: Effort) -> Findings:
    """All of C.

    Raises:
        LogError: the real logs are not there; said before any work is done.
    """
    for folder in (drive.FOLDER, smartloc.FOLDER, walk.FOLDER):
        real(folder)
    numbers = Numbers(EXPERIMENT, DATA, "simulated")
    conditions = CONDITIONS[:2] if effort.quick else CONDITIONS
    for k, condition in enumerate(conditions):
        judged(condition, numbers, _part(effort, k * DRIVES / len(conditions), DRIVES / len(conditions)))
    trains = Numbers(EXPERIMENT, "train", "simulated")
    rides(trains, _part(effort, DRIVES, 0.1))
    ours = Findings(
        (*numbers.rows(), *trains.rows()), sweeps(numbers), (*of_drives(numbers, effort.quick), *of_rides(trains))
    )
    return ours + nlos.nlos(_part(effort, 0.9, 0.05)) + walk.injected(_part(effort, 0.95, 0.05))


def _part(effort: Effort, begin: float, share: float) -> Effort:
    return replace(effort, tell=lambda doing, done: effort.tell(doing, begin + share * done))


STUDY = Study(
    "wang2023",
    "Faulty satellites of a train, one at a time or half of them",
    "Wang et al. 2023",
    study,
    {"C": "A filter of satellites and inertial unit, and who is left out of it"},
)
