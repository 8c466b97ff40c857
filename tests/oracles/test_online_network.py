"""The whole loop of Niu & Zhao 1998 in plain NumPy: foretell, compare, leave out, rebuild, learn by backpropagation."""

import jax.numpy as jnp
import numpy as np
import pytest

from laws.walk import Walk, walk
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.types import Sample
from sensorfault.core.verdicts import FAULT, OK, UNKNOWN
from sensorfault.numerics.networks.dense import Dense, Mlp
from sensorfault.runtime.runners import samples
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.rebuild import Rebuild
from sensorfault.stages.residual.online_network import OnlineNetwork
from sensorfault.stages.statistic.absolute import Absolute
from sensorfault.stages.threshold.sigma import Sigma

TICK_S, ROWS, HIDDEN, HORIZON = 0.01, 160, 4, 12
M, N = 2, 1  # y(k), y(k-1); u(k+1), u(k)
RHO, SIGMA = np.array([20.0, 12.0]), np.array([0.03, 0.02])
THETA = RHO * TICK_S + 3 * SIGMA
FAULTY = slice(70, 80)  # a drift of the first output, shorter than the horizon
CENTER, HALF, STEP = np.array([0.1, -0.2, 0.3]), np.array([1.0, 0.8, 1.2]), np.array([0.12, 0.1])
TOLERANCE, RATE, ITERATIONS, WARM = np.array([0.004, 0.003]), 0.6, 5, 8


def system(seed: int = 3, drift: float = 2.0) -> Sample:
    """Two coupled outputs of one input; a drift, a hole, a hole in the input and a gap in the clock."""
    random = np.random.default_rng(seed)
    u = np.sin(0.13 * np.arange(ROWS)) + 0.2 * random.standard_normal(ROWS)
    y = np.zeros((ROWS, 2))
    for k in range(1, ROWS):
        a, b = y[k - 1]
        y[k] = a + 0.1 * (b + 0.5 * u[k]), b + 0.1 * (u[k - 1] - np.sin(2 * a) - 0.4 * b)
    y += 0.004 * random.standard_normal((ROWS, 2))
    y[FAULTY, 0] += drift * THETA[0] * (1 + np.arange(10))
    y[100:103, 1] = np.nan
    u[110] = np.nan
    time = TICK_S * np.arange(ROWS) + np.where(np.arange(ROWS) >= 125, 1.0, 0.0)
    value = np.column_stack([y[:, 1], u, y[:, 0]])  # the outputs are columns 2 and 0
    return samples(time, value, np.ones(value.shape, bool))


def weights(seed: int = 1) -> list[np.ndarray]:
    random = np.random.default_rng(seed)
    inputs = 2 * M + N + 1
    return [
        random.uniform(-0.8, 0.8, (HIDDEN, inputs)),
        random.uniform(-0.2, 0.2, HIDDEN),
        random.uniform(-0.3, 0.3, (2, HIDDEN)),
        np.zeros(2),
    ]


def monitor(absolute: bool = False, warm: int = WARM, theta: np.ndarray = RHO, horizon: int = HORIZON) -> Monitor:
    w, b, v, c = map(jnp.asarray, weights())
    residual = OnlineNetwork(
        network=Mlp((Dense(w, b),), Dense(v, c)),
        center=jnp.asarray(CENTER),
        half=jnp.asarray(HALF),
        step=jnp.asarray(STEP),
        cov=jnp.eye(3),
        tolerance=jnp.asarray(TOLERANCE),
        settled=jnp.asarray(THETA),
        rate=jnp.asarray(RATE),
        warm=jnp.asarray(float(warm)),
        gap_s=jnp.asarray(1.5 * TICK_S),
        columns=(2, 0),
        driven=(1,),
        delays=(M, N),
        iterations=ITERATIONS,
        absolute=absolute,
    )
    rho, sigma = (jnp.asarray([x[1], np.inf, x[0]]) for x in (theta, SIGMA))
    return Monitor(
        residual=residual,
        branches=(Branch(Absolute(), Sigma(rho, sigma, jnp.asarray(TICK_S))),),
        decision=Exceed(),
        recovery=Rebuild(jnp.asarray((horizon + 0.5) * TICK_S), jnp.asarray(TICK_S / 2), 3),
        hold_s=jnp.zeros(3),
        owner=(0, 1, 2),
    )


class Plain:
    """One sample at a time, in the paper's order, as a reader of the paper would write it."""

    def __init__(self, absolute: bool) -> None:
        self.w, self.b, self.v, self.c = weights()
        self.absolute = absolute
        self.y = [CENTER[:2].copy() for _ in range(M)]  # the newest first
        self.u = [CENTER[2]] * N
        self.age = [0, 0]  # rows that each output has been in the window
        self.received = self.clean = self.quiet = 0
        self.time = self.last = -1e9
        self.trusted = [-1e9, -1e9]

    def forward(self, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        h = np.tanh(self.w @ x + self.b)
        return self.v @ h + self.c, h

    def push(self, time: float, y: np.ndarray, u: float) -> tuple[np.ndarray, np.ndarray, list[int]]:
        """Residual, what stands for each output, and the verdicts."""
        if time - self.time > 1.5 * TICK_S:
            self.age, self.received, self.clean = [0, 0], 0, 0
        self.received = 0 if np.isnan(u) else min(self.received + 1, N + 1)
        u = self.u[0] if np.isnan(u) else u
        x = [(self.y[0][i] - CENTER[i]) / HALF[i] for i in range(2)]
        x += [(self.y[j][i] - self.y[j + 1][i]) / STEP[i] for j in range(M - 1) for i in range(2)]
        x += [(one - CENTER[2]) / HALF[2] for one in (u, *self.u)]
        x = np.clip(x, -2, 2)
        origin, unit = (CENTER[:2], HALF[:2]) if self.absolute else (self.y[0], STEP)
        expected = origin + unit * self.forward(x)[0]
        there = ~np.isnan(y)
        residual = np.where(there, y, self.y[0]) - expected

        verdicts, taken, measured = [], np.zeros(2), np.zeros(2, bool)
        judged = self.quiet >= WARM
        for i in range(2):
            valid = there[i] and self.age[i] >= M and self.received > N and judged
            bad = valid and abs(residual[i]) > THETA[i]
            verdicts.append(FAULT if bad else OK if valid else UNKNOWN)
            measured[i] = there[i] and not bad
            filled = bad and time - self.trusted[i] <= (HORIZON + 0.5) * TICK_S
            low, high = CENTER[i] - HALF[i], CENTER[i] + HALF[i]
            taken[i] = y[i] if measured[i] else expected[i] if filled else min(max(expected[i], low), high)
            self.age[i] = min(self.age[i] + 1, M) if measured[i] or filled else 0
            self.trusted[i] = time if measured[i] else self.trusted[i]

        whole = self.clean >= M and self.received > N
        learns = [
            whole and measured[i] and (not judged or (verdicts[i] == OK and FAULT not in verdicts)) for i in range(2)
        ]
        self.learn(x, np.where(there, y, 0.0), origin, unit, np.array(learns))
        if not judged and any(learns):
            well = all(abs(residual[i]) <= THETA[i] for i in range(2) if learns[i])
            self.quiet = self.quiet + 1 if well else 0
        self.clean = min(self.clean + 1, M) if measured.all() else 0
        self.y, self.u, self.time = [taken, *self.y[:-1]], [u, *self.u[:-1]], time
        return residual, np.where(there, np.where(measured, y, expected), np.nan), verdicts

    def learn(self, x: np.ndarray, y: np.ndarray, origin: np.ndarray, unit: np.ndarray, learns: np.ndarray) -> None:
        for _ in range(ITERATIONS):
            result, h = self.forward(x)
            error = np.zeros(2)
            for i in np.flatnonzero(learns):
                e, small = (y[i] - origin[i]) / unit[i] - result[i], TOLERANCE[i] / unit[i]
                error[i] = 0.0 if abs(e) <= small else e - np.sign(e) * small
            if not error.any():
                return
            squares = 1 + (h**2).sum()
            gradient_w, gradient_b = np.zeros_like(self.w), np.zeros_like(self.b)
            for j in range(HIDDEN):
                for i in range(2):
                    delta = self.v[i, j] * (1 - h[j] ** 2)
                    squares += delta**2 * (1 + (x**2).sum())
                    gradient_w[j] += error[i] * delta * x
                    gradient_b[j] += error[i] * delta
            self.v = self.v + RATE / squares * np.outer(error, h)
            self.c = self.c + RATE / squares * error
            self.w = self.w + RATE / squares * gradient_w
            self.b = self.b + RATE / squares * gradient_b


@pytest.mark.parametrize("absolute", [False, True])
def test_the_whole_loop(absolute: bool) -> None:
    rows = system()
    result, plain = walk(monitor(absolute), rows), Plain(absolute)
    seen: set[int] = set()
    for k in range(ROWS):
        value = np.asarray(rows.value[k])
        residual, taken, verdicts = plain.push(float(rows.time[k]), value[[2, 0]], float(value[1]))
        there = np.isfinite(value[[2, 0]])
        np.testing.assert_array_equal(result.channel[k, [2, 0]], verdicts)
        close = {"rtol": 1e-9, "atol": 1e-11}
        np.testing.assert_allclose(result.reports.residual.value[k, [2, 0]][there], residual[there], **close)
        if k > 0:
            held = result.reports.trust.value[k, [2, 0]]
            trusted = (result.reports.trust.measured | result.reports.trust.filled)[k, [2, 0]]
            np.testing.assert_allclose(held[trusted], taken[trusted], **close)
        seen |= set(verdicts)
    network = result.states.residual.network
    for ours, theirs in (
        (network.hidden[0].weights, plain.w),
        (network.hidden[0].bias, plain.b),
        (network.output.weights, plain.v),
        (network.output.bias, plain.c),
    ):
        np.testing.assert_allclose(ours[-1], theirs, rtol=1e-8, atol=1e-10)
    assert seen == {OK, UNKNOWN, FAULT}


def learned(result: Walk) -> np.ndarray:
    """Whether the weights changed with each row."""
    w = result.states.residual.network.output.weights.reshape(ROWS, -1)
    return np.concatenate([[False], (np.diff(w, axis=0) != 0).any(axis=1)])


def test_a_drift_is_never_learned_and_learning_goes_on_after_it() -> None:
    result = walk(monitor(), system())
    assert (result.channel[FAULTY, 2] == FAULT).all()
    assert (np.abs(result.reports.residual.value[FAULTY, 2]) > THETA[0]).all()
    assert not learned(result)[FAULTY].any()
    assert learned(result)[FAULTY.stop + M : FAULTY.stop + 20].any()
    assert (result.channel[FAULTY.stop + 1 : 100][:, [0, 2]] == OK).all()


def test_no_lesson_reaches_across_a_hole_or_a_gap() -> None:
    rows = system()
    early = rows._replace(time=np.asarray(rows.time) + np.where(np.arange(ROWS) >= 6, 1.0, 0.0))  # not yet judged
    for log, closed in (
        (rows, slice(101, 103 + M)),  # a hole of three rows
        (rows, slice(125, 125 + M)),  # a gap in the clock
        (early, slice(6, 6 + M)),
    ):
        lessons = learned(walk(monitor(), log))
        assert lessons[closed.start - 2]
        assert not lessons[closed].any()
        assert lessons[closed.stop]
    value = np.asarray(rows.value).copy()
    value[125:, [0, 2]] += 0.05  # the arm moved while nobody looked
    assert not (walk(monitor(), rows._replace(value=value)).channel[125:, [0, 2]] == FAULT).any()


def test_a_fault_before_it_has_learned_is_unknown() -> None:
    rows = system(drift=0.0)
    value = np.asarray(rows.value).copy()
    value[3:8, 2] += 2 * THETA[0] * np.arange(1, 6)
    early = walk(monitor(), rows._replace(value=value))
    assert (early.channel[: M + WARM] == UNKNOWN).all()
    assert (early.sample[: M + WARM] == UNKNOWN).all()
    assert (early.channel[:, [0, 2]] == OK).any()


def test_the_stand_in_ends_at_its_horizon_and_the_sensor_is_unknown() -> None:
    rows = system(drift=0.0)
    value = np.asarray(rows.value).copy()
    value[70:, 2] += 1.0  # for good
    result = walk(monitor(horizon=5), rows._replace(value=value))
    filled = result.reports.trust.filled[70:90, 2]
    assert filled[:5].all()
    assert not filled[6:].any()
    assert (result.channel[70:75, 2] == FAULT).all()
    assert (result.channel[76:79, 2] == UNKNOWN).any()
