"""A feed-forward network of the same size, which Min et al. 2021 compare with their LSTM."""

from dataclasses import dataclass, field

from sensorfault.logs.table import Log
from sensorfault.methods.position.positions import Positions
from sensorfault.methods.position.predicted import LENGTH, from_windows
from sensorfault.methods.recipe import Recipe
from sensorfault.numerics.networks.dense import Mlp
from sensorfault.runtime.model import Model
from sensorfault.training.gradient import Plan, train
from sensorfault.training.initial import new_mlp
from sensorfault.training.session import Session
from sensorfault.training.windows import Windows

NAME = "mlp-predictor"


@dataclass(frozen=True)
class Size:
    """Rows of the window, units of each hidden layer, and the training plan."""

    length: int = LENGTH
    hidden: tuple[int, ...] = (16, 16)
    plan: Plan = field(default_factory=Plan)


def build(log: Log, seed: int, session: Session, size: Size = Size()) -> Model:
    """Fit on a healthy log."""

    def fit(windows: Windows) -> Mlp:
        inputs = windows.length * windows.rows.shape[1]
        network = new_mlp(seed, inputs, windows.target.shape[1], size.hidden)
        return train(network, windows, size.plan, seed, session).net

    return from_windows(NAME, log, size.length, fit)


RECIPE = Recipe(
    name=NAME,
    title="Position predicted by two hidden layers from the last 30 samples; limit: largest training error, scaled",
    source="Min et al. 2021, section 3.2, compared there with the LSTM",
    false_alarm_rate="not designed: the limit is the largest training error, scaled; fit measures the rate on "
    "held-out data",
    build=build,
    needs=Positions.of,
)
