"""Recipes that accuse the motion and no channel, where the car is under way."""

import numpy as np

from laws.case import Case
from laws.drives import CAR, UNDER_WAY, drive
from sensorfault.core.monitor import Monitor
from sensorfault.methods.catalog import METHODS
from sensorfault.runtime.runners import samples
from sensorfault.training.session import Session

BACK_S = 3.0
WINDOW_S = 10.0  # a window of the bicycle's innovations has forgotten


def fitted(name: str) -> Monitor:
    return METHODS[name].build(drive(300.0).select(CAR).between(120.0, 240.0), 0, Session()).monitor


def side_force() -> Case:
    """A yaw rate and a side force that do not go together."""
    part = drive(300.0).select(CAR).between(*UNDER_WAY)
    lie = np.zeros(10)
    lie[[2, 4]] = 6.0, 60.0  # rad/s and m/s^2: a low pass lets a fifteenth of one sample through
    rows = samples(part.time, part.value, part.fresh)
    return Case("side-force", fitted("side-force"), rows, lie, BACK_S, named=(), moving=(2, 4))


def bicycle() -> Case:
    """A fix off by 3 m or a speed off by 2 m/s: the filter takes it in, since nobody is accused, and soon agrees."""
    start_s, end_s = UNDER_WAY
    part = drive(300.0).select(CAR).between(start_s - 22.0, end_s + 18.0)
    lie = np.zeros(10)
    lie[[6, 7, 8]] = *np.deg2rad([3e-5, 3e-5]), 2.0
    rows = samples(part.time, part.value, part.fresh)
    return Case("bicycle-kalman", fitted("bicycle-kalman"), rows, lie, WINDOW_S + BACK_S, named=(), moving=(6, 7, 8))


CASES = {"side-force": side_force, "bicycle-kalman": bicycle}
HAVE = {"moving": tuple(CASES)}
