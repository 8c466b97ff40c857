"""The LSTM position predictor with which Min et al. 2021 detect transitional faults."""

from dataclasses import dataclass, field

from sensorfault.logs.table import Log
from sensorfault.methods.position.positions import Positions
from sensorfault.methods.position.predicted import LENGTH, from_windows
from sensorfault.methods.recipe import Recipe
from sensorfault.numerics.networks.lstm import Lstm
from sensorfault.runtime.model import Model
from sensorfault.training.gradient import Plan, train
from sensorfault.training.initial import new_lstm
from sensorfault.training.session import Session
from sensorfault.training.windows import Windows

NAME = "lstm-predictor"


@dataclass(frozen=True)
class Size:
    """Rows of the window, cells of each layer, and the training plan."""

    length: int = LENGTH
    cells: tuple[int, ...] = (16, 16)
    plan: Plan = field(default_factory=Plan)


def build(log: Log, seed: int, session: Session, size: Size = Size()) -> Model:
    """Fit on a healthy log."""

    def fit(windows: Windows) -> Lstm:
        network = new_lstm(seed, windows.rows.shape[1], windows.target.shape[1], size.cells)
        return train(network, windows, size.plan, seed, session).net

    return from_windows(NAME, log, size.length, fit)


RECIPE = Recipe(
    name=NAME,
    title="Position predicted by two LSTM layers from the last 30 samples; limit: largest training error, scaled",
    source="Min et al. 2021, section 2.2, equations (12)-(15)",
    false_alarm_rate="not designed: the limit is the largest training error, scaled; fit measures the rate on "
    "held-out data",
    build=build,
    needs=Positions.of,
)
