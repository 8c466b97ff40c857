"""Satellites and an inertial unit: six satellites that are always received, five inertial rows a second."""

import functools
from typing import NamedTuple

import numpy as np

from laws.case import Case
from sensorfault.core.monitor import Branch
from sensorfault.logs.epochs import Framing, framing
from sensorfault.logs.table import Log
from sensorfault.methods.gnss import innovation_tests, lof_efd, satellite_bank
from sensorfault.methods.gnss.gnss_ins import Filter, healthy, monitor, navigation
from sensorfault.runtime.runners import samples
from sensorfault.simulation import pseudorange
from sensorfault.simulation.ride import recorded
from sensorfault.simulation.train import ride

SATELLITES, EPOCHS, LIE_M = 6, 280, 150.0
DIGITS = 1e-5  # an innovation is what is left of 2.5e7 m, and the first position is found from nowhere
BACK_S = 40.0  # a window of twenty epochs has forgotten, and the filter is what it was


FALSE_ALARMS = 1e-5  # of an epoch: the laws want a quiet test
TESTS = {
    innovation_tests.CHI_SQUARE: lambda how: innovation_tests.whole(how, FALSE_ALARMS),
    innovation_tests.AVERAGED: lambda how: innovation_tests.averaged(
        how, SATELLITES, innovation_tests.WINDOW_S, FALSE_ALARMS
    ),
}


class _Ride(NamedTuple):
    framing: Framing
    epochs: Log


@functools.cache
def _ride(seed: int) -> _Ride:
    """A ride without tunnels."""
    true = ride(float(EPOCHS), seed=seed, noise="gaussian", imu_hz=5)
    high = np.argsort(-true.sky.elevation.mean(axis=0))[:SATELLITES]
    sky = true.sky.only(np.isin(np.arange(len(true.sky.names)), high))
    error = pseudorange.errors("gaussian", [seed], sky.elevation)[0]
    rate_error = np.zeros_like(error)
    inertial = true.log.value[:, :6]
    log = recorded("laws", true.log.time, inertial, true.epochs, sky, true.clock, error, rate_error)
    how = framing(log, sky.names, False)
    return _Ride(how, how.frame(log))


def navigating(name: str) -> Case:
    """A filter of these satellites alone, where a recipe has a place for each there is; fitted on one ride, before
    another under the same sky.
    """
    learned, unseen = _ride(1), _ride(2)
    how = learned.framing
    residual = navigation(how, Filter(bank=name == satellite_bank.NAME))
    if name in TESTS:
        branch = TESTS[name](how)
    else:
        innovations = healthy(how, learned.epochs, residual).normalised
        branch = _branch(name, how, innovations)
    epochs = unseen.epochs
    return Case(
        name,
        monitor(how, residual, branch),
        samples(epochs.time, epochs.value, epochs.fresh, epochs.block),
        lie=np.full(SATELLITES, LIE_M),
        back_s=BACK_S,
        named=(4,),
        tolerance=DIGITS,
    )


def _branch(name: str, how: Framing, innovations: np.ndarray) -> Branch:
    if name == satellite_bank.NAME:
        return satellite_bank.branch(how, satellite_bank.means(how, innovations), 8.0)
    known, factors = lof_efd.history(innovations, 0)
    return lof_efd.branch(how, known, 3 * float(factors.max()))


CASES = {name: functools.partial(navigating, name) for name in (satellite_bank.NAME, lof_efd.NAME, *TESTS)}
HAVE = {"block": tuple(CASES)}
