"""A1: spikes of one sample (shorts in the paper) on gyro and accelerometer of two real drives.

Min et al. 2021, section 4.1, figure 5.
"""

from collections.abc import Sequence

import numpy as np

from sensorfault_studies.findings import Effort, Figure, Findings, Row
from sensorfault_studies.min2021.copiers import Candidate, candidates
from sensorfault_studies.min2021.judged import PLAIN, RATES, Judged, judge
from sensorfault_studies.min2021.roc import plot
from sensorfault_studies.min2021.spikes import Drive

DRIVES = {"dresden_50hz": "dresden_50hz", "drive0708": "gnss_imu_drive0708"}
SIZES = (1.0, 2.0, 3.0, 5.0, 10.0)
QUICK_SIZES = (3.0, 5.0)
PAPER_AUC = {"elm-autoencoder": 0.7613, "bp-autoencoder": 0.7434}  # the sizes of the paper's spikes are not printed
PAPER_FIT_S = {"elm-autoencoder": 0.05, "bp-autoencoder": 3.54}  # on 27,515 rows
PAPER_RATIO = 3.54 / 0.05
ELM, BACKPROP = "elm-autoencoder", "bp-autoencoder"

Pairs = list[tuple[Candidate, Judged]]


def shorts(effort: Effort) -> Findings:
    """Every method on both drives at every size; with `quick` one seed, two sizes and a short training."""
    sizes = QUICK_SIZES if effort.quick else SIZES
    seeds = range(1 if effort.quick else effort.seeds)
    rivals = candidates(effort.quick)
    findings = Findings(())
    for i, (data, folder) in enumerate(DRIVES.items()):
        effort.progress(f"reading {data}", i / len(DRIVES))
        drive = Drive.of(folder)
        pairs: Pairs = []
        for j, rival in enumerate(rivals):
            effort.progress(f"{rival.method} on {data}", (i + (j + 0.5) / len(rivals)) / len(DRIVES))
            pairs.append((rival, judge(drive, rival, sizes, seeds)))
        findings += results(data, pairs, sizes)
    return findings


def results(data: str, pairs: Pairs, sizes: Sequence[float]) -> Findings:
    """Rows, figure and remarks of one drive."""
    rows = [row for rival, judged in pairs for row in _rows(data, rival, judged)]
    return Findings(
        (*rows, *_times(data, pairs), *_chance(data, sizes)), (_figure(data, pairs),), _remarks(data, pairs)
    )


def _row(data: str, condition: str, method: str, size: float | None, metric: str, values: Sequence[float]) -> Row:
    spread = float(np.std(values, ddof=1)) if len(values) > 1 else None
    return Row(
        "A1", data, "injected", condition, method, "spike", size, metric, float(np.mean(values)), spread, len(values)
    )


def _rows(data: str, rival: Candidate, judged: Judged) -> list[Row]:
    rows = []
    for (condition, metric, size), values in judged.number.items():
        if metric == "fit_s" or not (rival.main or metric == "auc"):
            continue
        row = _row(data, condition, rival.method, size, metric, values)
        paper = PAPER_AUC.get(rival.method) if rival.main and condition.endswith("pooled") else None
        rows.append(row if paper is None else Row(**row.as_dict() | {"paper": paper}))
    return rows


def _times(data: str, pairs: Pairs) -> list[Row]:
    """Fitting times of the two networks, the median over the seeds."""
    took = {r.method: (r.condition, judged.number[r.condition, "fit_s", None]) for r, judged in pairs if r.main}
    found = {method: float(np.median(took[method][1])) for method in PAPER_FIT_S}
    ratio = found[BACKPROP] / found[ELM]
    return [
        *(
            Row("A1", data, "real", took[m][0], m, None, None, "fit_s", found[m], None, len(took[m][1]), PAPER_FIT_S[m])
            for m in PAPER_FIT_S
        ),
        Row("A1", data, "real", took[ELM][0], ELM, None, None, "fit_times_faster", ratio, paper=PAPER_RATIO),
    ]


def _chance(data: str, sizes: Sequence[float]) -> list[Row]:
    """Expected numbers of random alarms."""
    random = [("", size, "auc", 0.5) for size in sizes]
    random += [(name, size, "recall", rate) for name, rate in RATES.items() for size in sizes]
    return [Row("A1", data, "injected", c, "chance", "spike", s, metric, value) for c, s, metric, value in random]


def _figure(data: str, pairs: Pairs) -> Figure:
    lines = {
        f"{rival.method}, AUC {judged.mean(f'{rival.condition} pooled', 'auc'):.3f}": judged.curve
        for rival, judged in pairs
        if rival.main
    }
    caption = f"Spikes of all sizes on {data}, first seed; figure 5 of the paper shows two of these curves."
    return Figure(f"a1_roc_{data}", f"Spikes on {data}: receiver operating characteristic", caption, plot(lines))


def _remarks(data: str, pairs: Pairs) -> tuple[str, ...]:
    """The reason for the paper's difference between both networks."""
    auc = {(r.method, r.condition): j.mean(r.condition, "auc", PLAIN) for r, j in pairs}
    main = {r.method: auc[r.method, r.condition] for r, _ in pairs if r.main}
    by_method = "; ".join(
        f"{r.method} {r.condition}: {np.mean(j.spike_left):.0%}, {np.mean(j.left):.1%}, "
        f"{auc[r.method, r.condition]:.3f}"
        for r, j in pairs
    )
    return (
        f"{data}: with 32 hidden nodes for 6 inputs both networks nearly copy their inputs, including spikes. At "
        f"{PLAIN:g} sigma the extreme learning machine is better by {main[ELM] - main[BACKPROP]:+.3f} because it "
        "copies values outside the training range less well, not because it models the drive better. Models that "
        "cannot copy (principal components, 3 hidden nodes, C = 0.01) and models that use earlier rows are compared "
        "here. Share of such a spike left in the residual, healthy residual as share of a channel's sigma, AUC: "
        f"{by_method}.",
    )
