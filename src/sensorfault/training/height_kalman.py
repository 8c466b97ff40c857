"""Fit the noise of the height's Kalman filter on a healthy log."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from dataclasses import replace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from sensorfault.core.types import Sample, Trust
from sensorfault.logs.table import Log
from sensorfault.runtime.runners import samples
from sensorfault.stages.residual.height_kalman import HeightKalman
from sensorfault.training.fixes import Fixes
from sensorfault.training.online import noise
from sensorfault.vehicles.fixed_wing import Roles

LEAST_M, LEAST_MPS = 0.02, 0.02  # no sensor is assumed to be better
WANDER_S = 10.0  # the random walk of the barometer's bias is measured over this time [s]
FORCE_WANDER = 1e-4  # variance that a second adds to the accelerometer's bias [(m/s^2)^2]
PUSHED = 0.5  # standard deviation of the upward acceleration that an inertial unit does not measure [m/s^2]


def fit_height_kalman(log: Log, height: int, roles: Roles) -> HeightKalman:
    """The filter of this height, with the log's other channels: climb rate, barometer, inertial unit with attitude.

    Measurement noise comes from third differences, process noise from increments. Then all variances are scaled so that
    the mean square of the height's normalised innovation is 1, which does not change the filter's gain.

    Raises:
        LogError: too few heights.
    """
    climb = roles.vertical if roles.vertical is not None else roles.inertial
    baro = roles.barometric if roles.barometric != height else None
    outputs = tuple(i for i in (height, climb, baro) if i is not None)
    fixes = Fixes.of(log, height, outputs)
    r = np.maximum(np.nan_to_num(noise(fixes.inputs)), LEAST_M) ** 2
    upward = roles.upward if roles.vertical is not None else roles.inertial_upward
    rows = np.zeros((len(outputs), 4))
    rows[0, 0] = 1.0
    wander = 1e-4
    if climb is not None:
        rows[1, 1] = upward
    if baro is not None:
        rows[-1, :3:2] = 1.0
        wander = _wander(fixes)
    inertial = roles.unit
    q = [PUSHED**2 if inertial else _pushed(fixes, climb is not None, r), wander, FORCE_WANDER if inertial else 0.0]
    made = HeightKalman(
        rows=jnp.asarray(rows),
        q=jnp.asarray(q),
        r=jnp.asarray(r),
        gap_s=jnp.asarray(fixes.gap_s),
        below=jnp.asarray(-1.0 if inertial and np.nanmedian(log.value[:, inertial[-1]]) > 0 else 1.0),
        outputs=outputs,
        inertial=inertial,
    )
    z = normalised(made, log)
    square = float(np.nanmean(z**2)) if np.isfinite(z).any() else 1.0
    return replace(made, q=made.q * square, r=made.r * square)


def normalised(filter: HeightKalman, log: Log) -> Float[np.ndarray, " T"]:
    """ν / √S of the height over a log in which every sample is trusted; NaN where nothing was tested."""
    value, cov, valid = _open_loop(filter, samples(log.time, log.value, log.fresh))
    c = filter.outputs[0]
    return np.where(np.asarray(valid)[:, c], np.asarray(value)[:, c] / np.sqrt(np.asarray(cov)[:, c, c]), np.nan)


@jax.jit
def _open_loop(filter: HeightKalman, rows: Sample) -> tuple[Array, Array, Array]:
    def one(state: Any, sample: Sample) -> tuple[Any, tuple[Array, Array, Array]]:
        residual, pending = filter.evaluate(state, sample)
        trust = Trust(sample.value, sample.fresh, sample.fresh & False, sample.fresh, sample.born)
        return filter.update(pending, trust), (residual.value, residual.cov, residual.valid)

    traces: tuple[Array, Array, Array] = lax.scan(one, filter.init(), rows)[1]
    return traces


def _pushed(fixes: Fixes, measured: bool, r: Float[np.ndarray, " O"]) -> float:
    """What a second adds to the variance of the climb rate [(m/s)^2], from the measured climb rate, else the height."""
    if measured:
        climb, own = fixes.inputs[:, 1], r[1]
    else:
        climb, own = np.diff(fixes.height) / np.diff(fixes.time), 2 * r[0] / fixes.period_s**2
    return float(max(np.nanvar(np.diff(climb)) - 2 * own, 1e-4)) / fixes.period_s


def _wander(fixes: Fixes) -> float:
    """What a second adds to the variance of the barometer's bias [m^2]."""
    bias = fixes.inputs[:, -1] - fixes.height
    lag = max(round(WANDER_S / fixes.period_s), 1)
    moved = bias[lag:] - bias[:-lag]
    return max(float(np.nanmean(moved**2)) / WANDER_S, 1e-6) if np.isfinite(moved).any() else 1e-4
