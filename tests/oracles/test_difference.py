"""The difference of two heights against a loop that keeps lists."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from laws.strict import strict
from laws.walk import Walk, walk
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.logs.table import Channel, Log, Sensor
from sensorfault.runtime.runners import samples
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.residual.difference import Difference
from sensorfault.stages.statistic.absolute import Absolute
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.difference import fit_difference

__all__ = ["strict"]

LAG_S, BEAT_S, GAP_S, WARM = 0.6, 1.0, 5.0, 10
HEIGHT, REFERENCE = 2, 0


def part(memory_s: float = np.inf, lag_s: float = LAG_S) -> Difference:
    numbers = (BEAT_S, lag_s, memory_s, GAP_S, 4.0)
    return Difference(*(jnp.asarray(x) for x in numbers), measured=HEIGHT, reference=REFERENCE, channels=3)


def through(residual: Difference, time: np.ndarray, value: np.ndarray, limit: float = np.inf) -> Walk:
    branch = Branch(Absolute(), Fixed(jnp.full(3, limit)))
    monitor = Monitor(residual, (branch,), Exceed(), Drop(), jnp.zeros(3), (0, 1, 2))
    return walk(monitor, samples(time, value, np.isfinite(value)))


def heights(seed: int, rows: int = 600, gap: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """An irregular clock of about 10 Hz; fixes on some ticks, the reference on others; holes in both."""
    rng = np.random.default_rng(seed)
    time = np.cumsum(rng.uniform(0.05, 0.15, rows)) + np.where(np.arange(rows) > rows // 2, 20.0 * gap, 0.0)
    climb = 3 * np.sin(time / 7)
    height = np.cumsum(climb * np.gradient(time))
    value = np.column_stack([height + 80, rng.standard_normal(rows), height + LAG_S * climb + 300])
    value[:, [REFERENCE, HEIGHT]] += 0.3 * rng.standard_normal((rows, 2))
    value[rng.random(rows) < 0.6, HEIGHT] = np.nan
    value[rng.random(rows) < 0.4, REFERENCE] = np.nan
    value[200:235, REFERENCE] = np.nan  # a hole longer than a beat
    return time, value


def loop(time: np.ndarray, value: np.ndarray, memory_s: float) -> dict[int, float]:
    """Row -> e, of every beat that is judged."""
    start, fixes, others = time[0], [], []
    before = None
    offset: list[float] = []
    level, learned, result = np.nan, -np.inf, {}
    for k, t in enumerate(time):
        if t - start > GAP_S:
            start, fixes, others = t, [], []
        if np.isfinite(value[k, HEIGHT]):
            fixes.append((t, value[k, HEIGHT]))
        if np.isfinite(value[k, REFERENCE]):
            others.append((t, value[k, REFERENCE]))
        if not np.isfinite(value[k, HEIGHT]) or t - start < 0.9 * BEAT_S:
            continue
        if others:
            now = np.mean(others, axis=0)
            if before is not None and t - before[0] <= GAP_S:
                speed = (now[1] - before[1]) / (now[0] - before[0])
                own = np.mean(fixes, axis=0)
                d = own[1] - (now[1] + speed * (own[0] - now[0] + LAG_S))
                if len(offset) == WARM:
                    result[k] = d - level
                    level += (1 - np.exp(-min(t - learned, GAP_S) / memory_s)) * (d - level)
                else:
                    offset.append(d)
                    level = float(np.mean(offset))
                learned = t
            before = now
        start, fixes, others = t, [], []
    return result


@pytest.mark.parametrize("memory_s", [np.inf, 20.0])
@pytest.mark.parametrize("gap", [False, True])
def test_every_beat_is_as_a_loop_says(memory_s: float, gap: bool) -> None:
    time, value = heights(1, gap=gap)
    result, expected = through(part(memory_s), time, value).reports.residual, loop(time, value, memory_s)
    rows = np.flatnonzero(result.valid[:, HEIGHT])
    assert rows.tolist() == list(expected)
    assert len(rows) > 30
    np.testing.assert_allclose(result.value[rows, HEIGHT], list(expected.values()), atol=1e-9)
    assert not result.valid[:, [0, 1]].any()


def test_what_stands_in_is_the_reference() -> None:
    """... with the offset, and the lag made up for, at every tick."""
    time, value = heights(2)
    result = through(part(), time, value).reports.residual
    late = time > 20
    truth = np.interp(time, time[np.isfinite(value[:, HEIGHT])], value[np.isfinite(value[:, HEIGHT]), HEIGHT])
    assert np.std((result.expected[:, HEIGHT] - truth)[late]) < 1.0


def test_a_distrusted_height_moves_no_offset() -> None:
    time, value = heights(3)
    wrong = value.copy()
    wrong[300:, HEIGHT] += 50.0
    states = through(part(20.0), time, wrong, limit=10.0).states.residual
    closed = np.flatnonzero(np.diff(np.asarray(states.offset)) != 0)
    assert closed.max() < 305
    believed = through(part(20.0), time, wrong).states.residual
    assert np.asarray(believed.offset)[-1] > np.asarray(states.offset)[-1] + 20


def test_the_lag_is_learned_and_no_climb_is_a_drift() -> None:
    time, value = heights(4, 3000)
    channels = tuple(Channel("altitude", name, "m") for name in ("barometer", "other", "gnss"))
    sensors = tuple(Sensor(channel.sensor, 0.1) for channel in channels)
    log = Log(time, value, np.isfinite(value), channels, sensors)
    found = fit_difference(part(lag_s=0.0), log)
    assert float(found.lag_s) == pytest.approx(LAG_S, abs=0.1)
    assert float(found.variance) < 0.3
    blind = fit_difference(part(lag_s=0.0), log, lagging=False)
    assert float(blind.variance) > 3 * float(found.variance)


def test_holes_poison_nothing() -> None:
    time, value = heights(5)
    states = through(part(), time, value).states.residual
    assert all(np.isfinite(np.asarray(x)).all() for x in jax.tree.leaves(states))
