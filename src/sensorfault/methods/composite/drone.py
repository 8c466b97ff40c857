"""The whole aircraft: heights against each other, attitude and inertial unit, position against velocity."""

from sensorfault.logs.table import Log
from sensorfault.methods.composite.composite import composite
from sensorfault.methods.height import height_agreement
from sensorfault.methods.inertial import relative_conditioning
from sensorfault.methods.position import motion_deficit
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model
from sensorfault.training.session import Session

PER_HOUR = 1.0
PARTS = (relative_conditioning.RECIPE, height_agreement.RECIPE, motion_deficit.RECIPE)


def _build(log: Log, seed: int, session: Session) -> Model:
    return composite(RECIPE.name, log, PARTS, PER_HOUR, seed, session, kept=(height_agreement.NAME,))


RECIPE = Recipe(
    name="drone-composite",
    title="Inertial unit and attitude by linear conditioning, heights against each other, position against velocity",
    source="Wang S. et al. and the methods that did better in this project's study (`sensorfault reproduce multistep`)",
    false_alarm_rate="one false alarm an hour for inertial unit and position, extrapolated from healthy scores; "
    "heights: not designed, each limit is 50 % above the largest healthy difference",
    build=_build,
    parts=PARTS,
)
