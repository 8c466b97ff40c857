"""An autoregressive model fitted by least squares, which Min et al. 2021 compare with their LSTM."""

from sensorfault.logs.table import Log
from sensorfault.methods.position.positions import Positions
from sensorfault.methods.position.predicted import LENGTH, from_windows
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model
from sensorfault.training.autoregression import fit_autoregression
from sensorfault.training.session import Session

NAME = "ar-predictor"


def build(log: Log, seed: int, session: Session, length: int = LENGTH) -> Model:
    """Fit on a healthy log; the fit is deterministic."""
    return from_windows(NAME, log, length, fit_autoregression)


RECIPE = Recipe(
    name=NAME,
    title="Position predicted by an autoregressive model of the last 30 samples; limit: largest training error, scaled",
    source="Min et al. 2021, section 3.2, compared there with the LSTM",
    false_alarm_rate="not designed: the limit is the largest training error, scaled; fit measures the rate on "
    "held-out data",
    build=build,
    needs=Positions.of,
)
