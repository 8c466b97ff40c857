"""The whole car: the best method for each group of sensors, under one false alarm budget."""

from dataclasses import replace
from functools import partial

from sensorfault.logs.table import Log
from sensorfault.methods.composite.composite import composite
from sensorfault.methods.inertial import relative_conditioning
from sensorfault.methods.position import bicycle_kalman, motion_deficit, side_force
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model
from sensorfault.training.session import Session

PER_HOUR = 1.0
# With levels: otherwise a large offset is trusted again after a second and spoils dead reckoning.
UNIT = replace(relative_conditioning.RECIPE, build=partial(relative_conditioning.build, levels=True))
MOTION = (motion_deficit.RECIPE, bicycle_kalman.RECIPE, side_force.RECIPE)


def _build(log: Log, seed: int, session: Session) -> Model:
    return composite(RECIPE.name, log, (UNIT, *MOTION), PER_HOUR, seed, session)


RECIPE = Recipe(
    name="car-composite",
    title="Inertial unit by linear conditioning, receiver by motion deficit, motion by bicycle filter and side force",
    source="Min et al. 2021 and the methods that did better in this project's study (`sensorfault reproduce min2021`)",
    false_alarm_rate="one false alarm an hour, extrapolated from the healthy scores of blocks left out of the fit",
    build=_build,
    parts=(relative_conditioning.RECIPE, *MOTION),
)
