"""Experiment A3: is what the bicycle's filter leaves normal, and what does it find. Figure 6 of the paper."""

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
from sensorfault_studies.min2021.normality_sizes import made, sizes

DRIVES = {"dresden_50hz": "road/dresden_50hz", "drive0708": "road/gnss_imu_drive0708", "rav4": "road/comma2k19_rav4"}
RAV4_WHEELBASE_M = 2.65
LEARN = 0.6
METHOD = "bicycle-kalman"
RIVALS = ("motion-deficit", "side-force", "car")
REMARKS = (
    "Jarque and Bera's statistic of the paper stays below 0.34 over a whole test drive; of 500 independent normal "
    "numbers only one window in six does, so so small a maximum says that the residuals were smoothed, not normal. "
    "On real logs it is far larger: innovations at 50 Hz repeat each other, and a receiver's errors come in bursts.",
    "The test does not change when all residuals are shifted or scaled: it is a reading beside the mean, the variance "
    "and the whitened innovation, never alone.",
    "The errors of a GNSS receiver that smooths its fixes are correlated over time. The spread of the innovations is "
    "fitted, their independence is not: the limits come from healthy blocks of time, not from a table.",
    "Dresden's training part holds a jump of the position of 5 m (28.9 s) and others of a metre; limits from the "
    "quartiles of the blocks do not learn them, and the model names them when it is run over its own training drive.",
    "Without a speed told by wheels a wheel slip is no fault that anything feels: the receiver tells the true speed. "
    "On the RAV4 (steering-angle form of (16), wheelbase 2.65 m, steering ratio learned) it is injected; the drive of "
    "60 s is too short to calibrate the windows, which therefore stay silent there.",
    "Dresden's receiver is late by 0.9 s, so that healthy turns look like slides, of which the filter finds hardly any "
    "there. The side force felt against speed times turn rate (side-force) does not ask the receiver where the car "
    "went: it finds slides from about 2 m/s. Slighter and slower ones stay within what a bumpy road does.",
    "A position that is off is told as a motion here: the method takes the sensors for healthy, as the paper does. "
    "A recipe that tests the sensors first says which of the two it is.",
)


def judged(data: str, method: str = METHOD) -> Judged:
    """A drive, the method fitted on its first part.

    Raises:
        LogError: the real logs are not there.
    """
    log = read(real(DRIVES[data]))
    if data == "rav4":
        log = replace(log, wheelbase_m=RAV4_WHEELBASE_M)
    cut = float(log.time[0]) + LEARN * log.duration_s
    learn = log.between(end_s=cut)
    return Judged(data, learn, log.between(cut), METHODS[method].build(learn, 0, SILENT), felt(learn))


def normality(effort: Effort) -> Findings:
    """All numbers of A3 on the three drives; `quick`: a few trials on one drive."""
    rows: list[Row] = list(made(effort.seeds))
    drawn = []
    drives = ("dresden_50hz",) if effort.quick else tuple(DRIVES)
    trials = 5 if effort.quick else 20
    for k, data in enumerate(drives):
        effort.tell(f"A3 {data}", k / len(drives))
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
    """Standard deviation of each normalised innovation on the part learned from and the rest."""
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
