"""All that must obey the laws: the toy guests, and the catalog.

To put a recipe under the laws, let `recipes` give a Case for it: a monitor fitted on one log, and a few hundred samples
of another one.
"""

import functools
from dataclasses import replace

import equinox as eqx
import numpy as np

from laws.case import Case
from laws.guests.zoo import zoo
from sensorfault.methods.catalog import METHODS
from sensorfault.methods.reconstructed import READMIT_S
from sensorfault.monitor.monitor import Monitor
from sensorfault.run import samples
from sensorfault.simulation.road import drive
from sensorfault.training.session import Session

IMU = [f"{sensor}.{axis}" for sensor in ("gyro", "accelerometer") for axis in "xyz"]


def recipes() -> list[Case]:
    """Each recipe of the catalog, fitted on four minutes of a simulated drive, before eight seconds of the fifth."""
    log = drive(300.0, seed=3).log.select(IMU)
    unseen = log.between(280.0, 288.0)
    rows = samples(unseen.time, unseen.value, unseen.fresh)
    lie = 40 * log.value.std(axis=0)
    made = []
    for name, recipe in METHODS.items():
        monitor = recipe.build(log.between(end_s=240.0), 0, Session()).monitor
        permuted = functools.partial(_permuted, monitor)
        made.append(Case(name, monitor, rows, lie, READMIT_S, permuted=permuted))
    return made


def _permuted(monitor: Monitor, order: np.ndarray) -> Monitor:
    """The monitor of a reconstruction for its channels in another order."""

    def parts(m: Monitor) -> list:
        r, (joint, each) = m.residual, m.branches
        vectors = [r.offset, r.center, r.half, r.watched, joint.statistic.scale, each.threshold.limit, m.hold_s]
        return [r.weights, r.output, r.cov, *vectors]

    weights, output, cov, *vectors = parts(monitor)
    moved = [weights[:, order], output[order], cov[order][:, order], *(vector[order] for vector in vectors)]
    return replace(eqx.tree_at(parts, monitor, moved), owner=tuple(monitor.owner[i] for i in order))


@functools.cache
def cases() -> tuple[Case, ...]:
    return (*zoo(), *recipes())
