"""Recipes that judge whole samples of an inertial unit: under the laws by being in the catalog's family."""

import functools
from dataclasses import replace

import equinox as eqx
import numpy as np

from laws.case import Case
from laws.drives import IMU, drive
from laws.family import family
from sensorfault.core.monitor import Monitor
from sensorfault.methods.catalog import METHODS
from sensorfault.methods.inertial import bp_autoencoder
from sensorfault.runtime.runners import samples
from sensorfault.stages.residual.conditioning import Conditioning
from sensorfault.stages.residual.reconstruction import Reconstruction
from sensorfault.stages.statistic.exchange import Exchange
from sensorfault.training.gradient import Plan
from sensorfault.training.session import Session

SMALL = {"bp-autoencoder": functools.partial(bp_autoencoder.build, plan=Plan(epochs=100, batch=256, rate=0.01))}


def inertial(name: str) -> Case:
    """A recipe fitted on four minutes of a simulated drive, before eight seconds of the fifth."""
    log = drive(300.0).select(IMU)
    unseen = log.between(280.0, 288.0)
    rows = samples(unseen.time, unseen.value, unseen.fresh)
    lie = 40 * log.value.std(axis=0)
    monitor = SMALL.get(name, METHODS[name].build)(log.between(end_s=240.0), 0, Session()).monitor
    back_s = float(monitor.recovery.readmit_s) + log.period_s * getattr(monitor.residual, "lags", 0)
    return Case(name, monitor, rows, lie, back_s, permuted=functools.partial(_permuted, monitor))


def _permuted(monitor: Monitor, order: np.ndarray) -> Monitor:
    """The monitor of a joint test and one of repeats, for its channels in another order."""
    residual = (_conditioning if isinstance(monitor.residual, Conditioning) else _reconstruction)(
        monitor.residual, order
    )

    def parts(m: Monitor) -> list:
        joint, each = m.branches
        scale = [joint.statistic.scale] if isinstance(joint.statistic, Exchange) else []
        return [*scale, each.threshold.limit, m.hold_s]

    moved = eqx.tree_at(parts, monitor, [vector[order] for vector in parts(monitor)])
    return replace(moved, residual=residual, owner=tuple(monitor.owner[i] for i in order))


def _reconstruction(residual: Reconstruction, order: np.ndarray) -> Reconstruction:
    vectors = ("offset", "center", "half", "watched")
    return replace(
        residual,
        weights=residual.weights[:, order],
        output=residual.output[order],
        cov=residual.cov[order][:, order],
        **{name: getattr(residual, name)[order] for name in vectors},
    )


def _conditioning(residual: Conditioning, order: np.ndarray) -> Conditioning:
    channels = len(order)
    lagged = np.concatenate([order + lag * channels for lag in range(residual.lags)])
    vectors = ("center", "drift", "most", "watched")
    return replace(
        residual,
        weights=residual.weights[order][:, lagged],
        cov=residual.cov[order][:, order],
        **{name: getattr(residual, name)[order] for name in vectors},
    )


CASES = {name: functools.partial(inertial, name) for name in family("inertial")}
HAVE = {"permuted": tuple(CASES)}
