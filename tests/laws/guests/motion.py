"""A monitor that judges how a body moves, and accuses no sensor."""

import numpy as np

from laws.case import Case
from laws.guests.statistics import Normalized
from laws.guests.zoo import SHARP, limits, log, position_log, three_positions
from sensorfault.core.monitor import Branch, Monitor


def moving_monitor() -> Monitor:
    made = three_positions(most=0)
    return Monitor(
        made.residual,
        (Branch(Normalized(), limits(SHARP, 3), subject="motion"),),
        made.decision,
        made.recovery,
        made.hold_s,
        made.owner,
    )


def moving() -> Case:
    """What the model of the motion cannot explain is the motion's fault; the filter takes it in and soon agrees."""
    lie = np.array([20.0, 20.0, 20.0])
    return Case("moving", moving_monitor(), log(position_log(8)), lie, 1.5, named=(), moving=(0, 1, 2))
