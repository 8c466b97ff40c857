"""The experiments of min2021, one after the other."""

from collections.abc import Callable
from dataclasses import replace

from sensorfault_studies.data import real
from sensorfault_studies.findings import Effort, Findings
from sensorfault_studies.min2021.bias_miss import bias_miss
from sensorfault_studies.min2021.jams import jams
from sensorfault_studies.min2021.normality import normality
from sensorfault_studies.min2021.shorts import shorts
from sensorfault_studies.study import Study

DATA = ("road/dresden_50hz", "road/gnss_imu_drive0708", "road/comma2k19_rav4")
EXPERIMENTS: dict[str, Callable[[Effort], Findings]] = {"A1": shorts, "A2": jams, "A3": normality, "A4": bias_miss}


def study(effort: Effort) -> Findings:
    """All of A1 to A4.

    Raises:
        LogError: some of the real logs are not there; said before any work is done.
    """
    for folder in DATA:
        real(folder)
    findings = Findings(())
    for i, (code, experiment) in enumerate(EXPERIMENTS.items()):
        findings += _filed(code, experiment(replace(effort, tell=_part(effort.tell, code, i, len(EXPERIMENTS)))))
    return findings


def _filed(code: str, findings: Findings) -> Findings:
    """The names of an experiment's figures begin with its code, which puts them below its tables; its remarks too."""
    figures = (
        figure if figure.name.startswith(code.lower()) else replace(figure, name=f"{code.lower()}-{figure.name}")
        for figure in findings.figures
    )
    remarks = (remark if remark.startswith(code) else f"{code}: {remark}" for remark in findings.remarks)
    return replace(findings, figures=tuple(figures), remarks=tuple(remarks))


def _part(tell: Callable[[str, float], None], code: str, i: int, count: int) -> Callable[[str, float], None]:
    """An experiment's own progress as a part of the study's."""

    def part(doing: str, share: float) -> None:
        said = doing if doing.startswith(code) else f"{code} {doing}"
        tell(said, (i + min(max(share, 0.0), 1.0)) / count)

    return part


STUDY = Study(
    "min2021",
    "Shorts, jams and abnormal motion of a car",
    "Min et al. 2021",
    study,
    {
        "A1": "Shorts of gyro and accelerometer",
        "A2": "Jams of the position",
        "A3": "Abnormal motion: is the residual normal?",
        "A4": "Bias and miss",
    },
)
