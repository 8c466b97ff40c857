"""The motion deficit, and the whole car, whose parts it is one of."""

from dataclasses import replace

import numpy as np

from laws.case import Case
from laws.drives import CAR, UNDER_WAY, drive
from sensorfault.methods.catalog import METHODS
from sensorfault.runtime.runners import samples
from sensorfault.training.session import Session


def deficit() -> Case:
    """The motion deficit, fitted on four minutes, in a part of the fifth in which the car is under way.

    Without one of its two numbers a position is none, nor is a velocity; without the inertial unit nothing is known of
    the velocity.
    """
    log = drive(300.0).select(CAR)
    monitor = METHODS["motion-deficit"].build(log.between(end_s=240.0), 0, Session()).monitor
    part = log.between(*UNDER_WAY)
    lie = np.concatenate([np.zeros(6), np.deg2rad([0.01, 0.01]), [40.0], [2.0]])
    lost = dict.fromkeys(range(6), (8, 9)) | {6: (7,), 7: (6,), 8: (9,), 9: (8,)}
    back_s = float(monitor.recovery.readmit_s) + 3.0
    rows = samples(part.time, part.value, part.fresh)
    return Case("motion-deficit", monitor, rows, lie, back_s, named=(6, 7, 8, 9), lost=lost)


def whole_car() -> Case:
    """All of it together: who answers for a channel is the part that knows it best."""
    alone = deficit()
    log = drive(300.0).select(CAR)
    monitor = METHODS["car-composite"].build(log.between(end_s=240.0), 0, Session()).monitor
    lie = np.concatenate([40 * log.value[:, :6].std(axis=0), alone.lie[6:]])
    return replace(alone, name="car-composite", monitor=monitor, lie=lie, named=None)


CASES = {"motion-deficit": deficit, "car-composite": whole_car}
