"""Persistence of a position or of each joint of an arm: a baseline that every predictor has to beat."""

from sensorfault.logs.table import Log
from sensorfault.methods.position.extrapolated import from_last
from sensorfault.methods.position.needs import joints_or_position
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model
from sensorfault.training.session import Session

NAME = "persistence"


def build(log: Log, seed: int, session: Session) -> Model:
    """Fit on a healthy log; the fit is deterministic."""
    return from_last(NAME, log, order=0)


RECIPE = Recipe(
    name=NAME,
    title="Position, or each joint of an arm, expected to equal the last sample",
    source="this project's baseline for Min et al. 2021, section 2.2, and Niu & Zhao 1998",
    false_alarm_rate="position: not designed, the limit is the largest training error, scaled; fit measures the rate "
    "on held-out data. Joints: one false alarm an hour over all joints, from the tail of the healthy residual",
    build=build,
    needs=joints_or_position,
)
