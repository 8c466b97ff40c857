"""The guests put together into monitors, each with a healthy log."""

import jax
import jax.numpy as jnp
import numpy as np
from scipy.stats import chi2, norm

from laws.case import Case, limits_learned
from laws.guests.bank import Bank, MemberFit
from laws.guests.filters import ConstantVelocity, Inertial, InertialRows
from laws.guests.learner import Nlms, RunningSigma
from laws.guests.statistics import Absolute, Normalized, Outlier, WindowMean
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.types import Sample
from sensorfault.runtime.runners import samples
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.recovery.rebuild import Rebuild
from sensorfault.stages.threshold.fixed import Fixed

STEP_S = 0.02
LONG = 400
SHARP = float(norm.isf(1e-9))


def zoo() -> tuple[Case, ...]:
    return (kalman(), windowed(), pairs(), learner(), block(), held(), bank())


def clock(length: int = LONG) -> np.ndarray:
    return STEP_S * np.arange(length)


def drive(rng: np.random.Generator, q: float, length: int = LONG, axes: int = 1) -> tuple[np.ndarray, np.ndarray]:
    """Positions and velocities (T, axes) of a body under white acceleration: exactly the filters' model."""
    dt = STEP_S
    root = np.linalg.cholesky(q * np.array([[dt**3 / 3, dt**2 / 2], [dt**2 / 2, dt]]))
    kick = rng.standard_normal((length, axes, 2)) @ root.T
    v = 10.0 + kick[..., 1].cumsum(axis=0)
    p = (dt * np.vstack([np.full((1, axes), 10.0), v[:-1]]) + kick[..., 0]).cumsum(axis=0)
    return p, v


def log(value: np.ndarray, fresh: np.ndarray | bool = True, block=(), time: np.ndarray | None = None) -> Sample:
    fresh = np.broadcast_to(fresh, value.shape)
    return samples(clock(len(value)) if time is None else time, value, fresh, block)


def monitor(residual, branches, owner, *, recovery=None, most=0, hold_s=0.0) -> Monitor:
    hold_s = jnp.broadcast_to(jnp.asarray(hold_s, float), (len(owner),))
    return Monitor(residual, branches, Exceed(), recovery or Drop(), hold_s, owner, most)


def limits(limit: float, tests: int) -> Fixed:
    return Fixed(jnp.full(tests, limit, float))


R3 = np.array([0.04, 0.25, 1.0])
Q = 0.5


def three_positions(order=(0, 1, 2), limit: float = SHARP, branches: tuple[Branch, ...] = (), most: int = 2) -> Monitor:
    """One axis, three position sensors of different quality."""
    h = jnp.asarray([[1.0, 0.0]] * 3)
    residual = ConstantVelocity(h, jnp.asarray(R3[list(order)]), jnp.asarray(Q, float), jnp.asarray([100.0, 30.0]))
    return monitor(residual, (Branch(Normalized(), limits(limit, 3)), *branches), (0, 1, 2), most=most)


def position_log(seed: int, length: int = LONG) -> np.ndarray:
    rng = np.random.default_rng(seed)
    p, _ = drive(rng, Q, length)
    return p + np.sqrt(R3) * rng.standard_normal((length, 3))


def kalman() -> Case:
    rate = 0.002
    quiet = [log(position_log(100 + seed, 2000)) for seed in range(30)]
    return Case(
        "kalman",
        three_positions(limit=float(norm.isf(rate / 2))),
        log(position_log(1)),
        lie=np.array([20.0, 20.0, 20.0]),
        back_s=0.5,
        permuted=lambda order: three_positions(order, limit=float(norm.isf(rate / 2))),
        quiet=jax.tree.map(lambda *one: np.stack(one), *quiet),
        rate=rate,
    )


def windowed() -> Case:
    """A window beside the instant test: its alarm names, and keeps nothing out of the filter."""

    def build(order=(0, 1, 2)) -> Monitor:
        window = Branch(WindowMean(3, 25), limits(6.0, 3), gates=False)
        return three_positions(order, branches=(window,), most=0)

    return Case("windowed", build(), log(position_log(2)), np.array([20.0, 20.0, 20.0]), back_s=1.0, permuted=build)


R5 = np.array([0.09, 0.25, 0.09, 0.25, 0.01])
PAIRS = (1, 0, 1, 0, 2)


def two_fixes(order=(0, 1, 2, 3, 4), most: int = 2) -> Monitor:
    """Two axes, two receivers with their channels interleaved, and a speedometer: each lie shows in every test."""
    h = np.array([[1, 0, 0, 0], [1, 0, 0, 0], [0, 1, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0]], float)
    order = list(order)
    residual = ConstantVelocity(
        jnp.asarray(h[order]), jnp.asarray(R5[order]), jnp.asarray(Q, float), jnp.asarray([100.0, 100.0, 30.0, 30.0])
    )
    return monitor(
        residual, (Branch(Outlier(), limits(SHARP, 5)),), tuple(int(s) for s in np.array(PAIRS)[order]), most=most
    )


def pairs() -> Case:
    rng = np.random.default_rng(3)
    p, v = drive(rng, Q, axes=2)
    value = np.stack([p[:, 0], p[:, 0], p[:, 1], p[:, 1], v[:, 0]], axis=1) + np.sqrt(R5) * rng.standard_normal(
        (LONG, 5)
    )
    return Case("pairs", two_fixes(), log(value), np.full(5, 30.0), back_s=0.5, permuted=two_fixes)


def learner() -> Case:
    """Nothing is known beforehand: weights and limits are learned, from what is trusted alone."""
    rng = np.random.default_rng(4)
    value = np.zeros((LONG, 2))
    for k in range(2, LONG):
        value[k] = 1.6 * value[k - 1] - 0.96 * value[k - 2] + 0.1 * rng.standard_normal(2)

    def build(order=(0, 1)) -> Monitor:
        sigma = RunningSigma(jnp.asarray(8.0, float), jnp.asarray(100.0, float), 2)
        rebuild = Rebuild(jnp.asarray(0.5, float), jnp.asarray(0.1, float), 2)
        return monitor(Nlms(jnp.asarray(0.5, float), 2), (Branch(Absolute(), sigma),), (0, 1), recovery=rebuild)

    return Case(
        "learner",
        build(),
        log(value),
        lie=np.array([5.0, 5.0]),
        back_s=0.8,
        learned=lambda state: (state.residual.weights, limits_learned(state)),
        permuted=build,
    )


ROWS = 4


def inertial(order=(0, 1), careful: bool = True) -> Monitor:
    residual = Inertial(
        h=jnp.asarray([[1.0, 0.0], [0.0, 1.0]])[jnp.asarray(order)],
        r=jnp.asarray([0.25, 0.01])[jnp.asarray(order)],
        spread=jnp.asarray([100.0, 30.0]),
        row_s=jnp.asarray(STEP_S / ROWS, float),
        sigma=jnp.asarray(0.1, float),
        ignorance=jnp.asarray(5.0, float),
        careful=careful,
    )
    return monitor(residual, (Branch(Normalized(), limits(SHARP, 2)),), (0, 1), most=1)


def block() -> Case:
    """Position and speed, carried along by four rows of an accelerometer a sample."""
    rng = np.random.default_rng(5)
    dt = STEP_S / ROWS
    acceleration = 2 * np.sin(np.arange(LONG * ROWS) * dt)
    v = 10 + (acceleration * dt).cumsum()
    p = (dt * np.hstack([10.0, v[:-1]]) + dt**2 / 2 * acceleration).cumsum()
    truth = np.stack([p, v], axis=1)[ROWS - 1 :: ROWS]
    rows = InertialRows(
        (acceleration + 0.1 * rng.standard_normal(LONG * ROWS)).reshape(LONG, ROWS), np.ones((LONG, ROWS), bool)
    )
    value = truth + np.array([0.5, 0.1]) * rng.standard_normal((LONG, 2))
    return Case("block", inertial(), log(value, block=rows), np.array([20.0, 5.0]), back_s=0.5, permuted=inertial)


def held() -> Case:
    """Wheel speed with every sample, two 10 Hz fixes that a 50 Hz log repeats four times each."""
    rng = np.random.default_rng(6)
    p, v = drive(rng, Q)
    r = np.array([0.01, 0.04, 0.25])
    value = np.hstack([v, p, p]) + np.sqrt(r) * rng.standard_normal((LONG, 3))
    fresh = np.ones((LONG, 3), bool)
    fresh[:, 1:] = (np.arange(LONG) % 5 == 0)[:, None]
    value[:, 1:] = value[::5, 1:].repeat(5, axis=0)

    def build(order=(0, 1, 2)) -> Monitor:
        order = list(order)
        h = np.array([[0.0, 1.0], [1.0, 0.0], [1.0, 0.0]])
        residual = ConstantVelocity(
            jnp.asarray(h[order]), jnp.asarray(r[order]), jnp.asarray(Q, float), jnp.asarray([100.0, 30.0])
        )
        hold_s = np.array([0.0, 0.25, 0.25])[order]
        return monitor(residual, (Branch(Normalized(), limits(SHARP, 3)),), (0, 1, 2), most=1, hold_s=hold_s)

    return Case("held", build(), log(value, fresh), np.array([5.0, 20.0, 20.0]), back_s=0.5, permuted=build)


R4 = np.array([0.04, 0.04, 0.09, 0.16])


def bank() -> Case:
    rng = np.random.default_rng(7)
    level = 0.5 * np.sqrt(STEP_S) * rng.standard_normal((LONG, 1)).cumsum(axis=0)
    value = level + np.sqrt(R4) * rng.standard_normal((LONG, 4))

    def build(order=(0, 1, 2, 3)) -> Monitor:
        residual = Bank(jnp.asarray(R4[list(order)]), jnp.asarray(0.25, float))
        return monitor(residual, (Branch(MemberFit(), limits(float(chi2.isf(1e-9, 3)), 4)),), (0, 1, 2, 3))

    return Case("bank", build(), log(value), np.full(4, 20.0), back_s=0.5, permuted=build)
