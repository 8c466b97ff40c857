"""An LSTM estimates the displacement of the last second without that second's positions, so a frozen receiver shows."""

from dataclasses import dataclass, field

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool

from sensorfault.calibration.open_loop import uncalibrated
from sensorfault.core.types import Report
from sensorfault.logs.table import Log
from sensorfault.methods.position.needs import positions_and_inertial
from sensorfault.methods.position.positions import GAP, Positions
from sensorfault.methods.position.predicted import limited
from sensorfault.methods.recipe import Recipe
from sensorfault.numerics.geodesy import SEMI_MAJOR_AXIS
from sensorfault.runtime.model import Model
from sensorfault.runtime.replay import replay_keeping
from sensorfault.stages.residual.displacement import Displacement, Seen
from sensorfault.training.gradient import Plan, train
from sensorfault.training.initial import new_lstm
from sensorfault.training.inputs import Inputs
from sensorfault.training.session import Session
from sensorfault.training.windows import Windows
from sensorfault.vehicles.car import moving

NAME = "lstm-displacement"
SECOND = 1.0  # the network does not get the positions of this last time [s]
STRIDE_S = 0.1  # samples within this time are averaged to one row of the window [s]
LEAST_MEND = 0.1  # [m]


@dataclass(frozen=True)
class Size:
    """Cells of each layer, and the training plan."""

    cells: tuple[int, ...] = (16, 16)
    plan: Plan = field(default_factory=Plan)


def build(log: Log, seed: int, session: Session, size: Size = Size()) -> Model:
    """Fit on a healthy log.

    Raises:
        LogError: no positions, neither velocity nor inertial unit, too little data, or a car that never moves.
    """
    positions, inertial = positions_and_inertial(NAME, log)
    untrained = _untrained(positions, inertial, seed, size)
    monitor = uncalibrated(limited(NAME, positions, untrained, {}, METRE / _cosines(positions)).monitor)
    seen, valid = jax.tree.map(np.asarray, replay_keeping(_seen, monitor, monitor.init(), log)[1])
    windows, mend = _windows(seen, valid[:, list(positions.columns)].all(axis=1))
    network = train(untrained.network, windows, size.plan, seed, session).net
    residual = eqx.tree_at(lambda r: (r.network, r.mend), untrained, (network, jnp.asarray(mend)))
    summary = {"inputs": [log.channels[i].path for i in (*inertial, *(positions.roles.velocity or ()))]}
    return limited(NAME, positions, residual, summary, METRE / _cosines(positions))


def _seen(report: Report) -> tuple[Seen, Bool[Array, " C"]]:
    return report.residual.extra, report.residual.valid


METRE = 1 / SEMI_MAJOR_AXIS  # [rad]


def _cosines(positions: Positions) -> np.ndarray:
    """Length of a degree of latitude and of longitude relative to the equator."""
    latitude = np.nanmedian(positions.log.value[:, positions.columns[0]])
    return np.array([1.0, max(float(np.cos(latitude)), 1e-3)])


def _untrained(positions: Positions, inertial: tuple[int, ...], seed: int, size: Size) -> Displacement:
    log, found = positions.log, positions.roles
    inputs = Inputs.of(log, inertial, 0, ())
    velocity = found.velocity or ()
    fastest = 20.0
    if found.velocity is not None:
        speeds = [v for v in (30.0, 20.0, 10.0, 5.0, 2.0) if len(moving(log, found, v))]
        fastest = speeds[0] if speeds else 2.0
    stride = max(1, round(STRIDE_S / log.period_s))
    steps = max(1, round(SECOND / log.period_s / stride))
    return Displacement(
        network=new_lstm(seed, len(inertial) + len(velocity) + 2, 2, size.cells),
        center=jnp.asarray(inputs.center),
        half=jnp.asarray(inputs.half),
        fastest=jnp.asarray(fastest),
        mend=jnp.asarray(1.0),
        cov=jnp.eye(len(log.channels)),
        gap_s=jnp.asarray(GAP * log.period_s),
        stale_s=jnp.asarray(positions.stale_s[list(positions.columns)].max()),
        size=steps * stride,
        stride=stride,
        position=positions.columns,
        inertial=inertial,
        velocity=velocity,
        polar=found.polar,
    )


def _windows(seen: Seen, valid: np.ndarray) -> tuple[Windows, float]:
    """Training windows: the displacement minus `base`, divided by its healthy RMS [m]; and that RMS."""
    left = np.asarray(seen.way - seen.base)[valid]
    mend = max(float(np.sqrt((left**2).mean())) if len(left) else 0.0, LEAST_MEND)
    rows = np.asarray(seen.window)[valid]
    count, length, width = rows.shape
    return Windows(rows.reshape(-1, width), np.arange(count) * length, left / mend, length), mend


RECIPE = Recipe(
    name=NAME,
    title="Displacement of the last second by an LSTM without that second's positions; limit: largest training "
    "error, scaled",
    source="after Min et al. 2021, section 2.2, for receivers that freeze at the last position (their jam fault)",
    false_alarm_rate="not designed: the limit is the largest training error, scaled; fit measures the rate on "
    "held-out data",
    build=build,
    needs=positions_and_inertial,
)
