"""The studies: a name, the paper, and what runs it."""

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
    """`experiments`: the title of each, by what its rows call it."""

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
            "Shorts, jams and abnormal motion of a car",
            "Min et al. 2021",
            min2021,
            {
                "A1": "Shorts of gyro and accelerometer",
                "A2": "Jams of the position",
                "A3": "Abnormal motion: is the residual normal?",
                "A4": "Bias and miss",
            },
        ),
        Study(
            "niu1998",
            "Sensors of a robot arm, and a network that learns while it watches",
            "Niu & Zhao 1998",
            niu1998,
            {"B": "Drifts, and faults of all kinds"},
        ),
        Study(
            "multistep",
            "Incipient drift of an aircraft's height, seen by an observer of many steps",
            "Wang S. et al.",
            multistep,
            {
                "D": "Ramps, observed over N steps",
                "D-slow": "Slow drift against a barometer, over a minute or more",
                "D-who": "Who is accused when a height drifts",
            },
        ),
        Study(
            "wang2023",
            "Satellites of a train that lie, one at a time or half of them",
            "Wang et al. 2023",
            wang2023,
            {"C": "A filter of satellites and inertial unit, and who is left out of it"},
        ),
        Study(
            "xu2023",
            "Ranges under water that lie, and fuzzy rules that foretell by how much",
            "Xu et al. 2023",
            xu2023,
            {
                "E": "Two leaders, one follower",
                "E-rules": "What can be learned of a range's error, every range taken in",
                "E-ranging": "Real ranges: walkers by radio, robots to landmarks, a dive by sound",
            },
        ),
    )
}
