"""The compared tests: those of Wang et al. 2023 and ours, each on the same filter with the same satellites."""

from dataclasses import dataclass, replace
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.calibration.density import density_limit
from sensorfault.calibration.means import fit_spread, mean_tape, windows
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.stage import Stage
from sensorfault.logs.epochs import Framing
from sensorfault.methods.gnss import innovation_tests, lof_efd, satellite_bank
from sensorfault.methods.gnss.gnss_ins import Filter, monitor, navigation
from sensorfault.numerics.blocks import enough
from sensorfault.stages.residual.ins_gnss import InsGnss
from sensorfault.stages.statistic.averaged_baarda_w import AveragedBaardaW
from sensorfault.stages.statistic.baarda_w import BaardaW
from sensorfault.stages.statistic.cumulative_bank import CumulativeBank
from sensorfault.stages.statistic.mahalanobis import Mahalanobis
from sensorfault.stages.statistic.means import Means
from sensorfault.stages.statistic.normalised import Normalised
from sensorfault.stages.statistic.standardised import Standardised
from sensorfault.stages.statistic.windowed_outlier_factor import WindowedOutlierFactor
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.outlier_factor import fit_history
from sensorfault_studies.wang2023.campaign import SETTLED, Case, flown

NONE, LOF, CHI_SQUARE, ALONE, OURS = (
    "no-exclusion",
    "lof-efd",
    "innovation-chi-square",
    "leave-one-out",
    "satellite-bank",
)
AIME_S = 10.0, 30.0, 60.0
CUMULATIVE, FEATURES = (1, 5, 10, 20, 40), (1, 10, 30)  # epochs
OUR_WINDOWS = tuple(round(one) for one in satellite_bank.WINDOWS)
SEED = 0  # of the history


@dataclass(frozen=True)
class Contender:
    """A method with its author's limit (None: not published), and with a limit to be set on each score."""

    name: str
    printed: Monitor | None
    free: Monitor | None


def contenders(of: Case, healthy: Float[np.ndarray, "N E S"], factor: float) -> tuple[Contender, ...]:
    """All methods, fitted on healthy runs; `factor`: of the pseudorange sigma in the filter."""
    how = of.framing
    alone, bank = (navigation(how, Filter(factor, on)) for on in (False, True))
    plain, spared = (flown(monitor(how, at), of, healthy) for at in (alone, bank))
    usual = len(how.channels)

    def free(statistic: Stage[Any, Any, Any, Any], at: InsGnss = alone, tests: int = usual) -> Monitor:
        return monitor(how, at, Branch(statistic, Fixed(jnp.inf * jnp.ones(tests))))

    def printed(branch: Branch) -> Monitor:
        return monitor(how, alone, branch)

    def averaged(w: float) -> Contender:
        window_s = w - how.period_s / 2
        statistic = AveragedBaardaW(jnp.asarray(window_s), usual, enough(w, how.period_s))
        return Contender(f"aime-{w:.0f}", printed(innovation_tests.averaged(how, usual, window_s)), free(statistic))

    def outliers(name: str, innovations: Float[np.ndarray, "N E C"], share: float, raw: bool) -> Contender:
        known, factors = lof_efd.history(np.concatenate(list(innovations[:, SETTLED:])), SEED)
        test = lof_efd.branch(how, known, density_limit(factors, share), raw)
        return Contender(name, printed(test), free(test.statistic))

    features, tape = scored(how, plain.normalised, FEATURES)
    many = fit_history(tape / np.asarray(features.spread), SEED)
    return (
        Contender(NONE, None, None),
        Contender(CHI_SQUARE, printed(innovation_tests.whole(how)), free(Standardised(Mahalanobis()), tests=1)),
        Contender("w-test", printed(innovation_tests.one_by_one(how, usual)), free(BaardaW())),
        *(averaged(w) for w in AIME_S),
        outliers(LOF, plain.normalised, lof_efd.FALSE_ALARMS, False),
        replace(outliers(f"{LOF}-1e-3", plain.normalised, 1e-3, False), free=None),
        outliers(f"{LOF}-raw", plain.innovation, lof_efd.FALSE_ALARMS, True),
        Contender("lof-windows", None, free(WindowedOutlierFactor(many, features))),
        Contender("cumulative", None, free(CumulativeBank(scored(how, plain.normalised, CUMULATIVE)[0]))),
        Contender(ALONE, None, free(Normalised(), bank)),
        Contender(OURS, None, free(CumulativeBank(scored(how, spared.normalised, OUR_WINDOWS)[0]), bank)),
    )


def without_exclusion(of: Case, factor: float) -> Monitor:
    """The filter that uses every measurement."""
    return monitor(of.framing, navigation(of.framing, Filter(factor)))


def scored(
    how: Framing, normalised: Float[np.ndarray, "N E C"], lengths: tuple[int, ...]
) -> tuple[Means, Float[np.ndarray, "M W"]]:
    """Windows of so many epochs with the spreads of these healthy innovations, and the means."""
    period = how.period_s
    means = windows(tuple(period * n for n in lengths), period, satellite_bank.GAP * period, normalised.shape[2])
    tape = np.concatenate([mean_tape(means, run[SETTLED:], period)[max(lengths) :] for run in normalised])
    tape = tape.reshape(-1, len(lengths))
    return fit_spread(means, tape), tape
