"""Predict the newest row linearly from the few rows before it: the baseline that a network has to beat."""

from sensorfault.logs.table import Log
from sensorfault.methods.inertial.conditioned import conditioned
from sensorfault.methods.inertial.needs import in_a_row
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model
from sensorfault.training.session import Session


def _build(log: Log, seed: int, session: Session) -> Model:
    return conditioned(RECIPE.name, log)


RECIPE = Recipe(
    name="linear-conditioning",
    title="Newest row given the four before it; largest whitened residual of a channel; limit: largest score on "
    "blocks left out, scaled",
    source="conditional mean of a Gaussian vector; limit as in Min et al. 2021, equations (10)-(11), cross-validated",
    false_alarm_rate="not designed: the limit is the largest score on healthy blocks left out of the fit, scaled",
    build=_build,
    needs=in_a_row,
)
