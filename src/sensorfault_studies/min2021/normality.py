"""Experiment A3: are the innovations of the bicycle filter normal, and what does it detect? Figure 6 of the paper."""

from dataclasses import replace

import numpy as np

from sensorfault.logs import read
from sensorfault.logs.table import Log
from sensorfault.methods.catalog import METHODS
from sensorfault.runtime.model import Model
from sensorfault.training.bicycle import WARM_S, normalised
from sensorfault.training.session import SILENT
from sensorfault_studies.data import real
from sensorfault_studies.findings import Effort, Findings, Row
from sensorfault_studies.min2021.normality_faults import BIASES_M, Judged, biases, felt, motions
from sensorfault_studies.min2021.normality_figures import figures
from sensorfault_studies.min2021.normality_sizes import simulated, sizes

DRIVES = {"dresden_50hz": "road/dresden_50hz", "drive0708": "road/gnss_imu_drive0708", "rav4": "road/comma2k19_rav4"}
RAV4_WHEELBASE_M = 2.65
LEARN = 0.6
METHOD = "bicycle-kalman"
RIVALS = ("motion-deficit", "side-force", "car-composite")
REMARKS = (
    "In the paper the Jarque-Bera statistic stays below 0.34 over a whole test drive. Of windows of 500 independent "
    "normal numbers only one in six does, so such a small maximum shows that the residuals were smoothed, not that "
    "they are normal. On real logs the statistic is far larger: innovations at 50 Hz are correlated, and a "
    "receiver's errors come in bursts.",
    "The statistic does not change if all residuals are shifted or scaled. It must be used together with the mean, the "
    "variance and the whitened innovation, never alone.",
    "The errors of a GNSS receiver that smooths its fixes are correlated over time. The fit sets the spread of the "
    "innovations but cannot make them independent, so the limits come from healthy blocks of time, not from a table.",
    "The training part of the Dresden drive contains a position jump of 5 m (at 28.9 s) and others of a metre. Limits "
    "from the quartiles of the block maxima do not learn them, and the model reports them on its own training drive.",
    "Without a wheel speed sensor no channel shows a wheel slip, because the receiver measures the true speed. On "
    "the RAV4 (steering-angle form of (16), wheelbase 2.65 m, steering ratio fitted) the slip is injected; its drive "
    "of 60 s is too short to calibrate the windows, which therefore raise no alarm there.",
    "The receiver of the Dresden drive has a lag of 0.9 s, so healthy turns look like slides and the filter detects "
    "hardly any slide there. The measured side force against speed times turn rate (side-force) does not use the "
    "receiver's position: it detects slides from about 2 m/s. Smaller and slower slides are within the effect of a "
    "bumpy road.",
    "A position fault is reported as abnormal motion here: the method assumes healthy sensors, as the paper does. A "
    "recipe that tests the sensors first can separate the two.",
)


def judged(data: str, method: str = METHOD) -> Judged:
    """A drive, with the method fitted on its first part.

    Raises:
        LogError: the real logs do not exist.
    """
    log = read(real(DRIVES[data]))
    if data == "rav4":
        log = replace(log, wheelbase_m=RAV4_WHEELBASE_M)
    cut = float(log.time[0]) + LEARN * log.duration_s
    learn = log.between(end_s=cut)
    return Judged(data, learn, log.between(cut), METHODS[method].build(learn, 0, SILENT), felt(learn))


def normality(effort: Effort) -> Findings:
    """All numbers of A3 on the three drives; with `quick` a few trials on one drive."""
    rows: list[Row] = list(simulated(effort.seeds))
    drawn = []
    drives = ("dresden_50hz",) if effort.quick else tuple(DRIVES)
    trials = 5 if effort.quick else 20
    for k, data in enumerate(drives):
        effort.progress(f"A3 {data}", k / len(drives))
        one = judged(data)
        rows += _spreads(one)
        if not effort.quick and data != "rav4":
            whole = _whole(one)
            found, kept = sizes(data, whole, one.filter)
            rows += found
            drawn += figures(data, one, whole, kept)
        rows += biases(one, trials, (2.0,) if effort.quick else BIASES_M)
        rivals: list[Model] = []
        if not effort.quick and data != "rav4":
            rivals = [METHODS[name].build(one.learn, 0, SILENT) for name in RIVALS]
        rows += motions(one, rivals, 1 if effort.quick else 6)
    return Findings(tuple(rows), tuple(drawn), REMARKS)


def _whole(one: Judged) -> Log:
    return replace(
        one.learn,
        time=np.concatenate([one.learn.time, one.rest.time]),
        value=np.concatenate([one.learn.value, one.rest.value]),
        fresh=np.concatenate([one.learn.fresh, one.rest.fresh]),
    )


def _spreads(one: Judged) -> list[Row]:
    """Standard deviation of each normalised innovation on the training part and on the rest."""
    rows = []
    whole = _whole(one)
    signal = normalised(one.filter, whole)
    cut = float(one.rest.time[0])
    parts = {"learned": (whole.time > whole.time[0] + WARM_S) & (whole.time < cut), "unseen": whole.time >= cut}
    for condition, part in parts.items():
        for column in one.filter.columns.measured:
            name = whole.channels[column].path
            x = signal[part & np.isfinite(signal[:, column]), column]
            for metric, value in (
                ("innovation_sd", float(x.std())),
                ("innovation_sd_robust", float(np.median(np.abs(x)) / 0.6745)),
            ):
                rows.append(Row("A3", one.data, "real", f"{condition} {name}", METHOD, None, None, metric, value))
    return rows
