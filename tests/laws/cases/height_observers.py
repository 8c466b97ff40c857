"""Observers of the height."""

import functools

import numpy as np

import flown
from laws.case import Case
from sensorfault.methods.height import kinematic_observer, multistep_observer
from sensorfault.runtime.runners import samples
from sensorfault.training.multistep import Schedule
from sensorfault.training.session import Session

OBSERVERS = {
    "multistep-observer": functools.partial(
        multistep_observer.build,
        setting=multistep_observer.Setting(steps=(1, 5), horizon_s=3.0, schedule=Schedule(epochs=20, rate=1e-2)),
    ),
    "kinematic-observer": functools.partial(
        kinematic_observer.build, setting=kinematic_observer.Setting((0.2, 1.0, 2.4), horizon_s=3.0)
    ),
}


def observer(name: str) -> Case:
    """An observer of the height in a part of the flight that it was not fitted on; without its inputs there is none."""
    log = flown.flight()
    monitor = OBSERVERS[name](log.between(end_s=160.0), 0, Session()).monitor
    part = log.between(160.0)
    inputs = (flown.DOWN,) if name == "kinematic-observer" else (flown.DOWN, flown.PITCH, flown.THROTTLE)
    return Case(
        name,
        monitor,
        samples(part.time, part.value, part.fresh),
        lie=np.where(np.arange(5) == flown.HEIGHT, 20.0, 0.0),
        back_s=3.0 + 12 * flown.FIX_S + 1.0,
        named=(flown.HEIGHT,),
        lost=dict.fromkeys(inputs, (flown.HEIGHT,)),
    )


CASES = {name: functools.partial(observer, name) for name in OBSERVERS}
