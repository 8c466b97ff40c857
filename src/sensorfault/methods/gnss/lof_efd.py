"""The method of Wang et al. 2023: local outlier factor of each satellite's innovation in a tightly coupled GNSS/INS."""

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.calibration.density import density_limit
from sensorfault.core.monitor import Branch
from sensorfault.logs.epochs import Framing
from sensorfault.logs.table import Log
from sensorfault.methods.gnss.gnss_ins import Filter, fitted, healthy, model, monitor, navigation
from sensorfault.methods.gnss.needs import framed
from sensorfault.methods.recipe import Recipe
from sensorfault.numerics.outlier_factor import LocalDensity
from sensorfault.runtime.model import Model
from sensorfault.stages.statistic.outlier_factor import OutlierFactor
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.outlier_factor import fit_history
from sensorfault.training.session import Session

NAME = "lof-efd"
FALSE_ALARMS = 0.01  # share of the kernel density above the limit


def history(innovations: Float[np.ndarray, "T C"], seed: int) -> tuple[LocalDensity, Float[np.ndarray, " n"]]:
    """The history of normal operation, and the outlier factors of all innovations in it."""
    seen = innovations[np.isfinite(innovations)]
    known = fit_history(seen[:, None], seed)
    return known, np.asarray(known.outlier_factor(jnp.asarray(seen[:, None])))


def branch(how: Framing, known: LocalDensity, limit: float, raw: bool = False) -> Branch:
    """LOF of each innovation. Wang et al. 2023, (10)-(13)."""
    return Branch(OutlierFactor(known, raw), Fixed(limit * jnp.ones(len(how.channels))))


def _build(log: Log, seed: int, session: Session) -> Model:
    session.progress("fitting the noise of the pseudoranges")
    how = framed(NAME, log)
    epochs = how.frame(log)
    own = fitted(how, epochs, Filter())
    session.progress("storing the history of normal operation")
    residual = navigation(how, own)
    known, factors = history(healthy(how, epochs, residual).normalised, seed)
    limit = density_limit(factors, FALSE_ALARMS)
    calibrated = monitor(how, residual, branch(how, known, limit))
    summary = {"false_alarms_of_density": FALSE_ALARMS, "limit": limit, "noise_factor": own.factor}
    return model(NAME, log, how, epochs, calibrated, ("outlier factor",), summary)


RECIPE = Recipe(
    name=NAME,
    title="GNSS/INS filter, local outlier factor of each satellite's innovation",
    source="Wang et al. 2023, (1)-(13)",
    false_alarm_rate="not reliable: designed for 1 % of epochs by a kernel density of the history, measured 7 to 22 %",
    build=_build,
    needs=framed,
)
