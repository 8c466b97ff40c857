"""The studies: name, paper, and the function that runs each."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from sensorfault_studies.findings import Effort, Findings
from sensorfault_studies.min2021.study import study as min2021
from sensorfault_studies.multistep.study import study as multistep
from sensorfault_studies.niu1998.study import study as niu1998
from sensorfault_studies.wang2023.study import study as wang2023
from sensorfault_studies.xu2023.study import study as xu2023


@dataclass(frozen=True)
class Study:
    """A study of one paper. `experiments`: code in the rows -> title."""

    name: str
    title: str
    paper: str
    run: Callable[[Effort], Findings]
    experiments: Mapping[str, str]


STUDIES: dict[str, Study] = {
    study.name: study
    for study in (
        Study(
            "min2021",
            "Spikes, frozen positions and abnormal motion of a car",
            "Min et al. 2021",
            min2021,
            {
                "A1": "Spikes of gyro and accelerometer",
                "A2": "Frozen positions",
                "A3": "Abnormal motion: is the residual normal?",
                "A4": "Offset and missing",
            },
        ),
        Study(
            "niu1998",
            "Sensors of a robot arm, and a network that learns online",
            "Niu & Zhao 1998",
            niu1998,
            {"B": "Drifts, and faults of all kinds"},
        ),
        Study(
            "multistep",
            "Incipient drift of an aircraft's height, and a multi-step observer",
            "Wang S. et al.",
            multistep,
            {
                "D": "Ramps, with an observer over N steps",
                "D-slow": "Slow drift against a barometer, over one minute or more",
                "D-who": "Which sensor is isolated when a height drifts",
            },
        ),
        Study(
            "wang2023",
            "Faulty satellites of a train, one at a time or half of them",
            "Wang et al. 2023",
            wang2023,
            {"C": "GNSS/INS filter, and the satellites that it excludes"},
        ),
        Study(
            "xu2023",
            "Faulty ranges under water, and fuzzy rules that predict their error",
            "Xu et al. 2023",
            xu2023,
            {
                "E": "Two leaders, one follower",
                "E-rules": "How well the error of a range can be learned, with every range used",
                "E-ranging": "Real ranges: pedestrians by radio, robots to landmarks, a dive by sound",
            },
        ),
    )
}
