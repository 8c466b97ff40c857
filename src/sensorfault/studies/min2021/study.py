"""The experiments of min2021, one after the other."""

from collections.abc import Callable
from dataclasses import replace
from importlib import import_module
from importlib.util import find_spec

from sensorfault.studies.data import real
from sensorfault.studies.findings import Effort, Findings

DATA = ("road/dresden_50hz", "road/gnss_imu_drive0708", "road/comma2k19_rav4")
EXPERIMENTS = {"A1": "shorts", "A2": "jams", "A3": "normality", "A4": "bias_miss"}  # each a file and its function


def study(effort: Effort) -> Findings:
    """All of A1 to A4.

    Raises:
        LogError: some of the real logs are not there; said before any work is done.
    """
    for folder in DATA:
        real(folder)
    here = __package__
    found = {code: name for code, name in EXPERIMENTS.items() if find_spec(f"{here}.{name}") is not None}
    findings = Findings(())
    for i, (code, name) in enumerate(found.items()):
        experiment: Callable[[Effort], Findings] = getattr(import_module(f"{here}.{name}"), name)
        findings += _filed(code, experiment(replace(effort, tell=_part(effort.tell, code, i, len(found)))))
    return findings


def _filed(code: str, findings: Findings) -> Findings:
    """The names of an experiment's figures begin with its code, which puts them below its tables."""
    figures = (
        figure if figure.name.startswith(code.lower()) else replace(figure, name=f"{code.lower()}-{figure.name}")
        for figure in findings.figures
    )
    return replace(findings, figures=tuple(figures))


def _part(tell: Callable[[str, float], None], code: str, i: int, count: int) -> Callable[[str, float], None]:
    """An experiment's own progress as a part of the study's."""

    def part(doing: str, share: float) -> None:
        said = doing if doing.startswith(code) else f"{code} {doing}"
        tell(said, (i + min(max(share, 0.0), 1.0)) / count)

    return part
