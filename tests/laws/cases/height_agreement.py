"""Heights and a vertical speed against each other."""

import numpy as np

import flown
from laws.case import Case
from sensorfault.methods.catalog import METHODS
from sensorfault.runtime.runners import samples
from sensorfault.training.session import Session


def heights() -> Case:
    """Heights and a vertical speed from fix to fix, each fix a beat of its own."""
    log = flown.flight(600.0, hz=1.0)
    monitor = METHODS["height-agreement"].build(log.between(end_s=200.0), 0, Session()).monitor
    part = log.between(200.0)
    every = (flown.HEIGHT, flown.DOWN, flown.BARO)
    return Case(
        "height-agreement",
        monitor,
        samples(part.time, part.value, part.fresh),
        lie=np.where(np.arange(5) == flown.HEIGHT, 60.0, 0.0),
        back_s=80.0,
        named=(flown.HEIGHT,),
        lost={flown.HEIGHT: every},
    )


CASES = {"height-agreement": heights}
