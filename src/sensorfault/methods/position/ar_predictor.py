"""Paper A's second comparator of the LSTM: an autoregressive model, by least squares."""

from sensorfault.logs.table import Log
from sensorfault.methods.position.predicted import LENGTH, Positions, from_windows
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model
from sensorfault.training.autoregression import fit_autoregression
from sensorfault.training.session import Session

NAME = "ar-predictor"


def build(log: Log, seed: int, session: Session, length: int = LENGTH) -> Model:
    """Fit on a healthy log; there is no chance in it."""
    return from_windows(NAME, log, length, fit_autoregression)


RECIPE = Recipe(
    name=NAME,
    title="Position predicted by an autoregressive model of the 30 samples before, scaled largest training error",
    source="Min et al. 2021, section 3.2: the comparator of the LSTM",
    promise="none: the limit is the largest training error, scaled; fit measures the rate on data it did not see",
    build=build,
    needs=lambda log: Positions.of(NAME, log),
)
