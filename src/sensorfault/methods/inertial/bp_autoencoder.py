"""The autoencoder trained by backpropagation, which Min et al. 2021 compare with their extreme learning machine."""

from sensorfault.logs.table import Log
from sensorfault.methods.common.rows import Training
from sensorfault.methods.inertial.reconstructed import reconstructed
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model
from sensorfault.training.backprop import PLAN, fit_backprop
from sensorfault.training.gradient import Plan
from sensorfault.training.session import Session

NAME = "bp-autoencoder"


def build(log: Log, seed: int, session: Session, plan: Plan = PLAN) -> Model:
    """Fit on a healthy log."""
    return reconstructed(NAME, log, lambda rows, scaling: fit_backprop(rows, scaling, 32, plan, seed, session))


RECIPE = Recipe(
    name=NAME,
    title="Autoencoder trained by backpropagation; norm of the reconstruction error; limit: largest training error, "
    "scaled",
    source="Min et al. 2021, section 3.1, compared there with the extreme learning machine",
    false_alarm_rate="not designed: the limit is the largest training error, scaled; fit measures the rate on "
    "held-out data",
    build=build,
    needs=Training.of,
)
