"""What every predictor has to beat: a position, or each joint of an arm, goes on as it went."""

from sensorfault.logs.table import Log
from sensorfault.methods.position.extrapolated import from_last, joints_or_position
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model
from sensorfault.training.session import Session

NAME = "linear-extrapolation"


def build(log: Log, seed: int, session: Session) -> Model:
    """Fit on a healthy log; there is no chance in it."""
    return from_last(NAME, log, order=1)


RECIPE = Recipe(
    name=NAME,
    title="Position, or else each joint of an arm, on the line through its last two; scaled largest training error",
    source="the baseline of Min et al. 2021, section 2.2, and of Niu & Zhao 1998",
    promise="of a position none: the limit is the largest training error, scaled; fit measures the rate on data it did "
    "not see. Of joints one false alarm an hour in all, from the tail of the healthy residual",
    build=build,
    needs=lambda log: joints_or_position(NAME, log),
)
