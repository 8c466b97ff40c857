"""Faults of single satellites, by a bank of filters that each leave one out: recommended for a train or a car."""

from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.calibration.limits import tail_limit
from sensorfault.calibration.means import fit_spread, mean_tape, windows
from sensorfault.calibration.open_loop import open_loop_scores
from sensorfault.core.monitor import Branch
from sensorfault.logs.epochs import Framing
from sensorfault.logs.table import Log
from sensorfault.methods.gnss.gnss_ins import Filter, Healthy, fitted, healthy, model, monitor, navigation
from sensorfault.methods.gnss.needs import framed
from sensorfault.methods.recipe import Recipe
from sensorfault.numerics.integrity import inert
from sensorfault.runtime.model import Model
from sensorfault.stages.statistic.cumulative_bank import CumulativeBank
from sensorfault.stages.statistic.means import Means
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.session import Session

NAME = "satellite-bank"
WINDOWS = 1.0, 5.0, 20.0  # epochs
GAP = 5.0  # a satellite's windows restart after this many epochs without it
PER_HOUR = 1.0  # false alarms an hour that the limit is set for
BLOCK_S = 30.0  # alarms within this time count once [s]
NINE_OF_TEN = 1.28  # 90 % quantile of the normal distribution
ALERT_M = 50.0  # a test that misses larger errors of a pseudorange is useless [m]


def means(how: Framing, innovations: Float[np.ndarray, "T C"]) -> Means:
    """Windows of innovations, with the spreads found on these healthy ones."""
    period = how.period_s
    new = windows(tuple(period * w for w in WINDOWS), period, GAP * period, len(how.channels))
    tape = mean_tape(new, innovations, period)[round(max(WINDOWS)) :]  # without the first windows, which are not full
    return fit_spread(new, tape.reshape(-1, len(WINDOWS)))


def branch(how: Framing, own: Means, limit: float) -> Branch:
    """For each satellite the largest mean over the windows, against the filter without that satellite."""
    return Branch(CumulativeBank(own), Fixed(limit * jnp.ones(len(how.channels))))


def _build(log: Log, seed: int, session: Session) -> Model:
    session.progress("fitting the noise of the pseudoranges")
    how = framed(NAME, log)
    epochs = how.frame(log)
    own = fitted(how, epochs, Filter(bank=True))
    session.progress("measuring how far each satellite is from the filter without it")
    residual = navigation(how, own)
    innovations = healthy(how, epochs, residual)
    windowed = means(how, innovations.normalised)
    uncalibrated = monitor(how, residual, branch(how, windowed, np.inf))
    score = open_loop_scores(uncalibrated, epochs)[0]
    tested = np.isfinite(score).any(axis=1)
    largest = np.where(tested, np.nanmax(np.where(np.isfinite(score), score, -np.inf), axis=1), np.nan)
    limit = float(tail_limit(largest[:, None], how.period_s, PER_HOUR, BLOCK_S)[0])
    calibrated = monitor(how, residual, branch(how, windowed, limit))
    summary = {"limit": limit, "noise_factor": own.factor, **_smallest(how, innovations, windowed, limit)}
    return model(NAME, log, how, epochs, calibrated, ("cumulative innovation",), summary)


def _smallest(how: Framing, innovations: Healthy, windowed: Means, limit: float) -> dict[str, Any]:
    """Smallest pseudorange step detected with probability 0.9, at its first epoch and within the longest window [m].

    For a satellite of median noise; with a warning where the step is larger than ALERT_M.
    """
    ranges = slice(len(how.satellites))
    sigma = float(np.nanmedian(innovations.innovation[:, ranges] / innovations.normalised[:, ranges]))
    spreads = windowed.spread[0], windowed.spread[-1]
    at_once, later = ((limit + NINE_OF_TEN) * float(spread) * sigma for spread in spreads)
    summary: dict[str, Any] = {"smallest_step_m": {"at once": at_once, f"in {how.period_s * WINDOWS[-1]:g} s": later}}
    if inert(np.array([at_once]), ALERT_M).any():
        summary["inert"] = (
            f"The filter's covariance is too large: a step below {at_once:.0f} m is not detected at once."
        )
    return summary


RECIPE = Recipe(
    name=NAME,
    title="Bank of GNSS/INS filters that each leave one satellite out; means of innovations over 1, 5 and 20 epochs",
    source="the filter of Wang et al. 2023; leave one out after Brown & McBurney 1988 (solution separation)",
    false_alarm_rate="1 false alarm an hour, extrapolated from the tail of the healthy log",
    build=_build,
    needs=framed,
)
