"""A follower that measures ranges to two leaders."""

import functools

import numpy as np

from laws.case import Case
from laws.family import family
from sensorfault.methods.catalog import METHODS
from sensorfault.runtime.runners import samples
from sensorfault.simulation.acoustic import Ranging
from sensorfault.simulation.underwater import sail
from sensorfault.training.session import Session


def follower(name: str) -> Case:
    """A follower and two leaders, all of it at every tick; a range needs both depths, and where its leader is."""
    log = sail(700.0, seed=2, ranging=Ranging(period_s=1.0, lost=0.0, alternating=False), surface_s=np.inf).log
    monitor = METHODS[name].build(log.between(end_s=400.0), 0, Session()).monitor
    part = log.between(399.0)
    ranges = tuple(i for i, channel in enumerate(log.channels) if channel.name == "range")
    own = {at + k: (at,) for at in ranges for k in (1, 2, 3)}
    return Case(
        name,
        monitor,
        samples(part.time, part.value, part.fresh),
        lie=np.where(np.isin(np.arange(len(log.channels)), ranges), 80.0, 0.0),
        back_s=30.0,
        named=ranges,
        lost={log.index("pressure.depth"): ranges, **own},
    )


CASES = {name: functools.partial(follower, name) for name in family("ranging")}
