"""The whole car: for each sensor group the part that does best, under one budget of false alarms."""

from dataclasses import replace
from functools import partial

from sensorfault.logs.table import Log
from sensorfault.methods.composite.composite import together
from sensorfault.methods.inertial import relative_conditioning
from sensorfault.methods.position import bicycle_kalman, motion_deficit, side_force
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model
from sensorfault.training.session import Session

PER_HOUR = 1.0
# With levels: a gross offset that is taken for the channel's own word after a second leads dead reckoning astray.
UNIT = replace(relative_conditioning.RECIPE, build=partial(relative_conditioning.build, levels=True))
PARTS = (UNIT, motion_deficit.RECIPE, bicycle_kalman.RECIPE, side_force.RECIPE)


def _build(log: Log, seed: int, session: Session) -> Model:
    return together(RECIPE.name, log, PARTS, PER_HOUR, seed, session)


RECIPE = Recipe(
    name="car",
    title="Inertial unit by linear conditioning, receiver by motion deficits, motion by bicycle filter and side force",
    source="Min et al. 2021 with what did better beside it: `sensorfault reproduce min2021` prints the comparison",
    promise="one false alarm an hour, extrapolated from the healthy scores of blocks left out of the fit",
    build=_build,
    parts=PARTS,
)
