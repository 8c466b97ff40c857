"""The tests that Wang et al. 2023 compare with, on the same filter, with the limits of the textbook."""

from functools import partial
from statistics import NormalDist

import jax.numpy as jnp

from sensorfault.calibration.chi_square import chi_square
from sensorfault.core.monitor import Branch
from sensorfault.logs.epochs import Framing
from sensorfault.logs.table import Log
from sensorfault.methods.gnss.gnss_ins import Filter, fitted, model, monitor, navigation
from sensorfault.methods.gnss.needs import framed
from sensorfault.methods.recipe import Recipe
from sensorfault.numerics.blocks import enough
from sensorfault.runtime.model import Model
from sensorfault.stages.statistic.averaged_baarda_w import AveragedBaardaW
from sensorfault.stages.statistic.baarda_w import BaardaW
from sensorfault.stages.statistic.mahalanobis import Mahalanobis
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.session import Session

FALSE_ALARMS = 0.01  # probability at one epoch
WINDOW_S = 30.0


def whole(how: Framing, false_alarms: float = FALSE_ALARMS) -> Branch:
    """q = zᵀ S⁻¹ z > χ²(m) of all satellites at once. Wang et al. 2023, section 1."""
    channels = len(how.channels)
    return Branch(Mahalanobis(), chi_square(false_alarms, channels))


def one_by_one(how: Framing, satellites: int, false_alarms: float = FALSE_ALARMS) -> Branch:
    """Baarda's w of each satellite; `satellites` of them share the false alarms."""
    return Branch(BaardaW(), _share(how, satellites, false_alarms))


def averaged(how: Framing, satellites: int, window_s: float, false_alarms: float = FALSE_ALARMS) -> Branch:
    """AIME of each satellite over a window. Diesel & Luu 1995."""
    channels = len(how.channels)
    slots = enough(window_s, how.period_s)
    return Branch(AveragedBaardaW(jnp.asarray(window_s), channels, slots), _share(how, satellites, false_alarms))


def _share(how: Framing, satellites: int, false_alarms: float) -> Fixed:
    limit = NormalDist().inv_cdf(1 - false_alarms / satellites / 2)
    return Fixed(limit * jnp.ones(len(how.channels)))


def usual(epochs: Log) -> int:
    """Mean number of measurements of an epoch, at least one."""
    return max(round(float(epochs.fresh.sum() / max(len(epochs), 1))), 1)


def _build(name: str, log: Log, seed: int, session: Session) -> Model:
    session.progress("fitting the noise of the pseudoranges")
    how = framed(name, log)
    epochs = how.frame(log)
    own = fitted(how, epochs, Filter())
    if name == AVERAGED:
        branch, test = averaged(how, usual(epochs), WINDOW_S), "averaged innovation"
    else:
        branch, test = whole(how), "*innovation"
    calibrated = monitor(how, navigation(how, own), branch)
    summary = {"false_alarms_per_epoch": FALSE_ALARMS, "noise_factor": own.factor}
    return model(name, log, how, epochs, calibrated, (test,), summary)


CHI_SQUARE = "innovation-chi-square"
AVERAGED = "averaged-innovation"
RECIPES = (
    Recipe(
        name=CHI_SQUARE,
        title="GNSS/INS filter, χ² of all innovations of an epoch",
        source="Wang et al. 2023, (1)-(9), for comparison",
        false_alarm_rate="0.01 of healthy epochs if innovations are white and Gaussian; real ones are not",
        build=partial(_build, CHI_SQUARE),
        needs=framed,
    ),
    Recipe(
        name=AVERAGED,
        title="GNSS/INS filter, averaged innovations (AIME)",
        source="Diesel & Luu 1995, as in Wang et al. 2023",
        false_alarm_rate="0.01 of healthy epochs if innovations are white and Gaussian; real ones are not",
        build=partial(_build, AVERAGED),
        needs=framed,
    ),
)
