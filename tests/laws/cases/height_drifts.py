"""Tests for a slow drift of a height."""

import functools
from dataclasses import replace

import numpy as np

from laws.case import Case
from sensorfault.methods.height import cusum, mean_pair, ramp_glr, slope
from sensorfault.methods.height.drifting import drift
from sensorfault.runtime.runners import samples
from sensorfault.simulation.flapping_wing import fly

DRIFTS = {test.name: test for test in (slope.TEST, mean_pair.TEST, ramp_glr.TEST, cusum.TEST)}


def drifting(name: str) -> Case:
    """A test for a slow drift, with a window of 20 s, on two heights at 1 Hz; without the barometer there is none.

    A window holds a fault for its length after the end, and a sum comes down again as slowly.
    """
    log = fly(1000.0, seed=5, beat_hz=0.0, imu_hz=1.0, gnss_hz=1.0, barometer_hz=1.0).log
    log = log.select(["gnss.altitude", "barometer.altitude"])
    setting = replace(DRIFTS[name].setting, window_s=20.0, margin=1.3)
    monitor = drift(log.between(end_s=600.0), replace(DRIFTS[name], setting=setting)).monitor
    part = log.between(600.0)
    rows = samples(part.time, part.value, part.fresh)
    return Case(name, monitor, rows, lie=np.array([500.0, 0.0]), back_s=60.0, named=(0,), lost={1: (0,)})


CASES = {name: functools.partial(drifting, name) for name in DRIFTS}
