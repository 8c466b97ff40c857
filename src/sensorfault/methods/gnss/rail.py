"""Faults of single satellites by filters that each leave one out: what is recommended for a train, or a car."""

from functools import partial
from typing import Any

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.calibration.limits import tail_limit
from sensorfault.calibration.means import fit_spread, mean_tape, windows
from sensorfault.core.monitor import Branch
from sensorfault.logs.epochs import Framing
from sensorfault.logs.table import Log
from sensorfault.methods.gnss.gnss_ins import (
    Filter,
    Healthy,
    fitted,
    framed,
    healthy,
    model,
    monitor,
    navigation,
)
from sensorfault.methods.recipe import Recipe
from sensorfault.numerics.integrity import inert
from sensorfault.runtime.model import Model
from sensorfault.runtime.replay import replay_log
from sensorfault.stages.statistic.cumulative_bank import CumulativeBank
from sensorfault.stages.statistic.means import Means
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.session import Session

NAME = "rail"
WINDOWS = 1.0, 5.0, 20.0  # epochs
GAP = 5.0  # epochs without a satellite after which its windows begin anew
PER_HOUR = 1.0  # false alarms promised
BLOCK_S = 30.0  # alarms within are one
NINE_OF_TEN = 1.28  # quantile of a normal number
ALERT_M = 50.0  # error of a pseudorange beyond which a gate that sleeps is no gate


def means(how: Framing, innovations: Float[np.ndarray, "T C"]) -> Means:
    """Windows of innovations with the spreads of these healthy ones."""
    period = how.period_s
    new = windows(tuple(period * w for w in WINDOWS), period, GAP * period, len(how.channels))
    tape = mean_tape(new, innovations, period)[round(max(WINDOWS)) :]  # windows that are not yet full count as nought
    return fit_spread(new, tape.reshape(-1, len(WINDOWS)))


def branch(how: Framing, own: Means, limit: float) -> Branch:
    """The largest of the windows' means of each satellite, against a filter without it."""
    return Branch(CumulativeBank(own), Fixed(limit * jnp.ones(len(how.channels))))


def _build(log: Log, seed: int, session: Session) -> Model:
    session.tell("fitting the noise of pseudoranges")
    how = framed(NAME, log)
    epochs = how.frame(log)
    own = fitted(how, epochs, Filter(bank=True))
    session.tell("how far each satellite may be from a filter without it")
    residual = navigation(how, own)
    told_of = healthy(how, epochs, residual)
    seen = means(how, told_of.normalised)
    uncalibrated = monitor(how, residual, branch(how, seen, np.inf))
    score = np.asarray(replay_log(uncalibrated, epochs).scores[0])
    tested = np.isfinite(score).any(axis=1)
    largest = np.where(tested, np.nanmax(np.where(np.isfinite(score), score, -np.inf), axis=1), np.nan)
    limit = float(tail_limit(largest[:, None], how.period_s, PER_HOUR, BLOCK_S)[0])
    calibrated = monitor(how, residual, branch(how, seen, limit))
    result = {"limit": limit, "noise_factor": own.factor, **_smallest(how, told_of, seen, limit)}
    return model(NAME, log, how, epochs, calibrated, ("cumulative innovation",), result)


def _smallest(how: Framing, told_of: Healthy, seen: Means, limit: float) -> dict[str, Any]:
    """The step of a pseudorange that nine of ten times is found with its first epoch, and within the longest window,
    at a satellite of middling noise [m]; and a warning where that is more than could matter.
    """
    ranges = slice(len(how.satellites))
    sigma = float(np.nanmedian(told_of.innovation[:, ranges] / told_of.normalised[:, ranges]))
    at_once, later = ((limit + NINE_OF_TEN) * float(spread) * sigma for spread in (seen.spread[0], seen.spread[-1]))
    result: dict[str, Any] = {"smallest_step_m": {"at once": at_once, f"in {how.period_s * WINDOWS[-1]:g} s": later}}
    if inert(np.array([at_once]), ALERT_M).any():
        result["inert"] = f"A step below {at_once:.0f} m passes unseen at first: the filter doubts itself too much."
    return result


RECIPE = Recipe(
    name=NAME,
    title="GNSS/INS filters that each leave a satellite out, means of their innovations over 1, 5 and 20 epochs",
    source="after Wang et al. 2023, whose filter it is; leave one out: Brown & McBurney 1988 (solution separation)",
    promise=f"{PER_HOUR:g} false alarm an hour, extrapolated from the tail of the healthy log",
    build=_build,
    needs=partial(framed, NAME),
)
