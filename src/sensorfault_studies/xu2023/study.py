"""Paper E: ranges under water that lie, told by chi-square, by fuzzy rules, and by what we stand for."""

from collections.abc import Iterator
from dataclasses import replace

from sensorfault_studies.data import real
from sensorfault_studies.findings import Effort, Findings, Row
from sensorfault_studies.study import Study
from sensorfault_studies.xu2023 import ranging, rules
from sensorfault_studies.xu2023.figures import of_missions
from sensorfault_studies.xu2023.missions import CONDITIONS, Result, judged
from sensorfault_studies.xu2023.remarks import PAPER, remarks

FOLDERS = ("underwater/snapir_auv", "underwater/ugps_g2_acoustic", "ranging/uwb_outdoor", "ranging/mrclam")
JUDGED, LEARNED = 0.85, 0.1  # shares of the work


def study(effort: Effort) -> Findings:
    """All of E.

    Raises:
        LogError: the real paths or ranges are not there; said before any work is done.
    """
    for folder in FOLDERS:
        real(folder)
    result = []
    for k, condition in enumerate(CONDITIONS):
        share = JUDGED / len(CONDITIONS)
        result.append(judged(condition, _part(effort, k * share, share)))
    rows = tuple(row for one in result for row in rows_of(one))
    figures = tuple(figure for one in result for figure in of_missions(one))
    missions = Findings(rows, figures, remarks(result))
    learned = rules.findings(_part(effort, JUDGED, LEARNED))
    return missions + learned + ranging.findings(_part(effort, JUDGED + LEARNED, 1 - JUDGED - LEARNED))


def _part(effort: Effort, begin: float, share: float) -> Effort:
    return replace(effort, tell=lambda doing, done: effort.tell(doing, begin + share * done))


def rows_of(result: Result) -> Iterator[Row]:
    """With the paper's numbers beside its own methods, as printed, on the simulated mission."""
    for row in result.numbers.rows():
        variant = row.condition.removeprefix(result.condition.words).removesuffix("as-printed").strip()
        printed = PAPER.get(f"{row.method} {variant}".strip())
        here = result.condition.data == "simulated" and result.condition.words != "fast"
        if printed is None or not here or not row.condition.endswith("as-printed"):
            yield row
            continue
        tp, tn, fp, fn = printed
        paper = dict(zip(("tp", "tn", "fp", "fn"), map(float, printed), strict=True))
        paper |= {"accuracy": (tp + tn) / sum(printed), "precision": tp / (tp + fp), "recall": tp / (tp + fn)}
        paper |= {"fpr": fp / (tn + fp), "fnr": fn / (tp + fn)}
        yield replace(row, paper=paper.get(row.metric))


STUDY = Study(
    "xu2023",
    "Wrong ranges under water, and fuzzy rules that predict by how much",
    "Xu et al. 2023",
    study,
    {
        "E": "Two leaders, one follower",
        "E-rules": "What can be learned of a range's error, every range taken in",
        "E-ranging": "Real ranges: walkers by radio, robots to landmarks, a dive by sound",
    },
)
