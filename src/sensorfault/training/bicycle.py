"""Fit noise, lags and mounting of the bicycle-model Kalman filter on a healthy drive."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from collections.abc import Callable

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import Sample, Trust
from sensorfault.logs.table import Log, LogError
from sensorfault.runtime.runners import samples
from sensorfault.stages.residual.bicycle_kalman import Belief, BicycleKalman, Columns
from sensorfault.training.bicycle_data import _fast, check_bicycle
from sensorfault.training.mounting import fit_mounting
from sensorfault.vehicles.car import Roles, moving

MOST_ROWS = 8000  # the noise is fitted on at most so many rows, from where the car first moves
WARM_S = 10.0  # the start of a filter is ignored for this long [s]
HUBER = 3.0  # a larger normalised innovation counts by its size, not its square
ROUNDS = 15  # rounds of the search for noise and lags
FIRST_STEP = (0.7,) * 8 + (0.1, 0.1, 0.02)
BIAS_WALK = 1e-8  # of the turn rate's bias [(rad/s)^2 per s]; too slow to be seen in a short drive
# sd of: position [m/√s], heading [rad/√s], speed [m/s/√s], bias of acceleration [m/s^2/√s], a fix along and across [m],
# velocity [m/s]
START = (0.1, 0.01, 0.3, 0.05, 0.1, 0.1, 0.05)
LEAST = (1e-3, 1e-4, 1e-2, 1e-3, 1e-2, 1e-2, 1e-2)
FARTHEST = (0.5, 0.5, 0.1)  # lag of position and velocity [s], logarithm of the scale of the speed


def fit_bicycle(
    log: Log, found: Roles, wheelbase_m: float | None = None, steering_ratio: float | None = None
) -> BicycleKalman:
    """The filter for the car of this healthy drive; Q, R and lags by maximum likelihood.

    The turn rate comes from the steering angle if log and wheelbase are given, else from the gyro.

    Raises:
        LogError: the wheelbase is not positive, a channel is missing, or the car hardly moves.
    """
    if wheelbase_m is not None and not wheelbase_m > 0:
        raise LogError(f"{log.name}: wheelbase_m is {wheelbase_m:g}; it must be positive, the distance of the axles.")
    check_bicycle(log, found)
    fitted = _descend(_start(log, found, wheelbase_m, steering_ratio), log, found)
    healthy: BicycleKalman = eqx.tree_at(lambda m: m.spread, fitted, jnp.asarray(healthy_spread(fitted, log)))
    return healthy


def _velocity(log: Log, found: Roles) -> tuple[int, ...]:
    """Columns of north and east velocity, else of one speed: the wheels' speed if another sensor has it more often."""
    if found.north is not None and found.east is not None:
        return found.north, found.east
    assert found.speed is not None
    assert found.position is not None
    receiver = log.channels[found.position[0]].sensor
    own = [i for i, c in enumerate(log.channels) if c.name == "speed" and c.unit == "m/s" and c.sensor != receiver]
    often = [i for i in own if log.fresh[:, i].sum() > log.fresh[:, found.speed].sum()]
    return (often[0] if often else found.speed,)


def _start(log: Log, found: Roles, wheelbase_m: float | None, steering_ratio: float | None) -> BicycleKalman:
    """The filter with the mounting of its sensors, before the fit of the noise."""
    assert found.position is not None
    steered = found.steering is not None and wheelbase_m is not None
    accelerometer: tuple[int, ...] = found.accelerometer or ()
    forward, push = np.zeros(3), 0.0
    turning, lean = np.ones(1), 0.0
    try:
        mounted = fit_mounting(log, found)
    except LogError:
        if not steered:
            raise
        forward, push = _push(
            log, found
        )  # the drive is too straight to find the gyro's mounting, which is not needed here
    else:
        forward = mounted.thrust * mounted.forward
        push = float(forward @ mounted.accelerometer_bias)
        turning = -mounted.yaw  # a course is clockwise, φ anticlockwise
        lean = float(turning @ mounted.gyro_bias)
    if found.steering is not None and wheelbase_m is not None:
        gain, lean = steering(log, found, wheelbase_m)
        turning = np.array([np.copysign(1 / steering_ratio, gain) if steering_ratio else gain])
    velocity = _velocity(log, found)
    return BicycleKalman(
        columns=Columns(
            position=found.position,
            velocity=velocity,
            accelerometer=accelerometer,
            gyro=() if steered else found.gyro or (),
            steering=(found.steering,) if steered and found.steering is not None else (),
        ),
        forward=jnp.asarray(forward),
        turning=jnp.asarray(turning),
        wheelbase=jnp.asarray(wheelbase_m or 1.0),
        q=jnp.ones(6),
        r=jnp.ones(2 + len(velocity)),
        spread=jnp.ones(2 + len(velocity)),
        smooth_s=jnp.asarray(0.1),
        late_s=jnp.zeros(2),
        speed_scale=jnp.ones(()),
        bias=jnp.asarray([lean, push]),
        bias_spread=jnp.asarray([0.005, 0.3]),
        channels=len(log.channels),
    )


def steering(log: Log, found: Roles, wheelbase_m: float) -> tuple[float, float]:
    """Front wheel angle = gain . steering angle - offset, fitted to the course rate by least squares.

    l (course rate) / v = tan δ, small angles; anticlockwise is positive. One over `gain` is the steering ratio.

    Raises:
        LogError: the log has no course.
    """
    if found.velocity is None or found.steering is None:
        raise LogError(
            f"{log.name} has no course over ground to fit the steering ratio; give steering_ratio in vehicle.toml."
        )
    first, second = found.velocity
    rows = log.fresh[:, second] & np.isfinite(log.value[:, [first, second]]).all(axis=1)
    a, b = log.value[rows, first], log.value[rows, second]
    speed, course = (np.abs(a), b) if found.polar else (np.hypot(a, b), np.arctan2(b, a))
    time, course = log.time[rows], np.unwrap(course)
    there = np.isfinite(log.value[:, found.steering])
    angle = np.interp(log.time, log.time[there], log.value[there, found.steering])
    turned = np.concatenate([[0.0], np.cumsum((angle[1:] + angle[:-1]) / 2 * np.diff(log.time))])
    at = np.arange(time[0] + 3.0, time[-1], 0.2)
    way = np.interp(at, time, speed)
    at, way = at[way > 3.0], way[way > 3.0]
    curvature = -(np.interp(at, time, course) - np.interp(at - 1, time, course)) / np.maximum(way, 3.0)
    best = (np.inf, 0.0, 0.0)
    for lag in np.arange(0.0, 1.5, 0.05):
        mean = np.interp(at - lag, log.time, turned) - np.interp(at - lag - 1, log.time, turned)
        (gain, offset), left, *_ = np.linalg.lstsq(
            np.stack([mean, np.ones(len(at))], axis=1), wheelbase_m * curvature, rcond=None
        )
        if left.size and left[0] < best[0]:
            best = float(left[0]), float(gain), float(-offset)
    return best[1], best[2]


def _push(log: Log, found: Roles) -> tuple[Float[np.ndarray, "3"], float]:
    """Speed rate = f . accelerometer - bias, by least squares over one second; zeros if a channel is missing."""
    if found.accelerometer is None or found.speed is None:
        return np.zeros(3), 0.0
    rows = log.fresh[:, found.speed] & np.isfinite(log.value[:, found.speed])
    at = np.arange(log.time[0] + 2.0, log.time[-1], 0.2)
    speed = np.interp(np.stack([at, at - 1]), log.time[rows], log.value[rows, found.speed])
    columns = [np.ones(len(at))]
    for column in found.accelerometer:
        there = np.isfinite(log.value[:, column])
        value = np.interp(log.time, log.time[there], log.value[there, column])
        total = np.concatenate([[0.0], np.cumsum((value[1:] + value[:-1]) / 2 * np.diff(log.time))])
        columns.append(np.interp(at, log.time, total) - np.interp(at - 1, log.time, total))
    level, *f = np.linalg.lstsq(np.stack(columns, axis=1), speed[0] - speed[1], rcond=None)[0]
    return np.array(f), -float(level)


@jax.jit
def _chunk(
    filter: BicycleKalman, belief: Belief, rows: Sample
) -> tuple[Belief, tuple[Float[Array, "T M"], Float[Array, "T M"], Bool[Array, "T M"], Float[Array, "T C"]]]:
    def one(belief: Belief, sample: Sample) -> tuple[Belief, tuple[Array, Array, Array, Array]]:
        residual, work = filter.evaluate(belief, sample)
        none = jnp.zeros_like(sample.fresh)
        belief = filter.update(work, Trust(sample.value, sample.fresh, none, sample.fresh, sample.born))
        whole = jnp.where(residual.valid, residual.value / jnp.sqrt(jnp.diagonal(residual.cov)), jnp.nan)
        return belief, (work.innovation, jnp.sqrt(jnp.diagonal(work.s)), work.there, whole)

    done: tuple[Belief, tuple[Array, Array, Array, Array]] = jax.lax.scan(one, belief, rows)
    return done


def open_loop(
    filter: BicycleKalman, log: Log
) -> tuple[Float[np.ndarray, "T M"], Float[np.ndarray, "T M"], Bool[np.ndarray, "T M"], Float[np.ndarray, "T C"]]:
    """Innovations of the filter over a log in which every sample is trusted.

    Returns the innovations along and across the heading and of the velocities, their standard deviations, and whether
    each exists; and e / √S of each channel, NaN where nothing was measured or the filter had not started.
    """
    belief, parts = filter.init(), []
    for start in range(0, len(log), MOST_ROWS):
        belief, tapes = _chunk(filter, belief, _rows(log, start))
        parts.append([np.asarray(tape) for tape in tapes])
    innovation, sigma, there, whole = (np.concatenate(tapes)[: len(log)] for tapes in zip(*parts, strict=True))
    return innovation, sigma, there, whole


def _rows(log: Log, start: int) -> Sample:
    """MOST_ROWS rows from this one on, so that one compilation serves every log; those after its end are empty."""
    cut = slice(start, start + MOST_ROWS)
    time, value, fresh = log.time[cut], log.value[cut], log.fresh[cut]
    after = (0, MOST_ROWS - len(time))
    empty = np.pad(value, (after, (0, 0)), constant_values=np.nan)
    return samples(np.pad(time, after, "edge"), empty, np.pad(fresh, (after, (0, 0))))


def _descend(filter: BicycleKalman, log: Log, found: Roles) -> BicycleKalman:
    """Q, R, lags and the scale of the speed by maximum likelihood of the innovations, with Huber's loss."""
    rows = _rows(log, int(np.searchsorted(log.time, _first(log, found) - 1.0)))
    warm = rows.time > rows.time[0] + min(WARM_S, float(rows.time[-1] - rows.time[0]) / 4)
    return _made(filter, jnp.asarray(_search(lambda x: float(_loss(filter, jnp.asarray(x), rows, warm)))))


def _made(filter: BicycleKalman, x: Float[Array, "11"]) -> BicycleKalman:
    """The filter with these logarithms of standard deviations and these lags."""
    way, heading, speed, push, along, across, velocity = jnp.exp(2 * jnp.maximum(x[:7], jnp.log(jnp.asarray(LEAST))))
    late = jnp.clip(x[8:], -jnp.asarray(FARTHEST), jnp.asarray(FARTHEST))
    q = jnp.stack([way, way, heading, speed, jnp.asarray(BIAS_WALK), push])
    r = jnp.concatenate([jnp.stack([along, across]), jnp.full(len(filter.r) - 2, velocity)])
    made: BicycleKalman = eqx.tree_at(
        lambda m: (m.q, m.r, m.smooth_s, m.late_s, m.speed_scale),
        filter,
        (q, r, jnp.clip(jnp.exp(x[7]), 1e-3, 2.0), late[:2], jnp.exp(late[2])),
    )
    return made


@jax.jit
def _loss(filter: BicycleKalman, x: Float[Array, "11"], rows: Sample, warm: Bool[Array, " T"]) -> Float[Array, ""]:
    """Mean of -2 ln p of the innovations after the start, with Huber's loss."""
    e, sigma, there, _ = _chunk(_made(filter, x), filter.init(), rows)[1]
    there = there & warm[:, None]
    z = jnp.abs(jnp.where(there, e / sigma, 0.0))
    # -2 ln p = ln S + z², with Huber's 2 k |z| - k² beyond k
    size = jnp.where(z < HUBER, z**2, 2 * HUBER * z - HUBER**2)
    return jnp.where(there, 2 * jnp.log(sigma) + size, 0.0).sum() / jnp.maximum(there.sum(), 1)


def _search(loss: Callable[[Float[np.ndarray, "11"]], float]) -> Float[np.ndarray, "11"]:
    """Pattern search (Hooke & Jeeves 1961): compiling the gradient would take as long as a hundred replays."""
    x = np.array([*np.log(START), np.log(0.1), 0.0, 0.0, 0.0])
    step = np.array(FIRST_STEP)
    best = loss(x)
    for _ in range(ROUNDS):
        before = x.copy()
        for k in range(len(x)):
            for sign in (1, -1):
                tried = x.copy()
                tried[k] += sign * step[k]
                if (value := loss(tried)) < best:
                    x, best = tried, value
                    step[k] *= 1.3 * sign  # try this direction first next time
                    break
            else:
                step[k] /= 2
        along = 2 * x - before
        if (value := loss(along)) < best:
            x, best = along, value
    return x


def _first(log: Log, found: Roles) -> float:
    times = moving(log, found) if found.velocity else _fast(log, found)
    return float(times[0])


def healthy_spread(filter: BicycleKalman, log: Log) -> Float[np.ndarray, " M"]:
    """RMS of each normalised innovation, without the start and without the largest 0.2 %."""
    e, sigma, there, _ = open_loop(filter, log)
    late = log.time > log.time[0] + WARM_S
    spread = np.ones(e.shape[1])
    for k in range(len(spread)):
        z = np.sort(np.abs(e[:, k] / sigma[:, k])[there[:, k] & late])
        kept = z[: max(int(0.998 * z.size), 1)]
        if kept.size:
            spread[k] = max(float(np.sqrt((kept**2).mean())), 1e-3)
    return spread


def normalised(filter: BicycleKalman, log: Log) -> Float[np.ndarray, "T C"]:
    """e / √S of each channel, NaN where nothing was measured or the filter had not started."""
    return open_loop(filter, log)[3]
