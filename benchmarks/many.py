"""The simulated work of bench_gpu.py: many faulty runs through three monitors, and many trainings at once."""

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from bench_follower import METHOD as FOLLOWER
from bench_navigation import EPOCHS, STEP_M, run
from common import IMU

import sensorfault as sf
from sensorfault.core.monitor import Monitor, MonitorState
from sensorfault.core.types import Report, Sample
from sensorfault.methods.catalog import DEFAULT, METHODS
from sensorfault.runtime.runners import replay, samples
from sensorfault.simulation.underwater import sail
from sensorfault.training.gradient import begin, one_epoch
from sensorfault.training.initial import new_lstm
from sensorfault.training.session import SILENT
from sensorfault.training.windows import OnDevice

SIZES = 1, 100, 1000, 10_000, 100_000
RANGES, ROWS = 40, 500
LENGTH, BATCHES, BATCH, CELLS, RATE = 30, 10, 64, (16, 16), 1e-3


class Work(NamedTuple):
    """`run`, compiled, of the shared data and of the data of each run (first axis); `own(N)` gives these for N runs."""

    name: str
    run: Callable[[Any, Any], Any]
    shared: Any
    own: Callable[[int], Any]
    sizes: tuple[int, ...]
    agree: float  # bar: largest difference, relative to the largest output


def kept(report: Report) -> tuple[jax.Array, jax.Array]:
    return report.residual.value, report.verdict.channel


@jax.jit
def judged(shared: tuple[Monitor, MonitorState, Sample], value: jax.Array) -> tuple[jax.Array, jax.Array]:
    monitor, start, rows = shared
    return jax.vmap(lambda one: replay(monitor, start, rows._replace(value=one), kept)[1])(value)


def replays(name: str, monitor: Monitor, log: sf.Log, last: int, sigma: float, step: float) -> Work:
    """The last rows of a log; each run has its own noise, and a step on one channel from the middle on."""
    rows, cut = samples(log.time, log.value, log.fresh, log.block), len(log) - last
    before, after = (jax.tree.map(lambda x, part=part: x[part], rows) for part in (slice(cut), slice(cut, None)))
    start = jax.jit(partial(replay, keep=kept))(monitor, monitor.init(), before)[0]
    value = np.asarray(after.value)

    def own(count: int) -> np.ndarray:
        values = value + sigma * np.random.default_rng(0).standard_normal((count, *value.shape))
        for i, one in enumerate(values):
            one[last // 2 :, i % value.shape[1]] += step
        return values

    return Work(name, judged, (monitor, start, after), own, SIZES, 1e-6)


@jax.jit
def trained(examples: OnDevice, own: tuple[Any, jax.Array]) -> jax.Array:
    return jax.vmap(lambda net, batches: one_epoch(begin(net, RATE), examples, batches, LENGTH)[1])(*own)


def networks() -> Work:
    """LSTMs of Min et al. 2021, one epoch of ten batches each, with their own order and initial weights."""
    windows = BATCHES * BATCH
    rows = np.tanh(np.cumsum(np.random.default_rng(0).standard_normal((windows + LENGTH, 8)), axis=0) / 50)
    first, rows = jnp.arange(windows, dtype=jnp.int32), jnp.asarray(rows, jnp.float32)
    net = jax.tree.map(np.asarray, new_lstm(0, 8, 2, CELLS))

    def own(count: int) -> tuple[Any, np.ndarray]:
        random = np.random.default_rng(1)
        nets = jax.tree.map(lambda x: np.float32(x * random.uniform(0.5, 1.5, (count, *x.shape))), net)
        order = random.permuted(np.tile(np.arange(windows, dtype=np.int32), (count, 1)), axis=1)
        return nets, order.reshape(count, BATCHES, BATCH)

    examples = OnDevice(rows, first, rows[LENGTH:, :2])
    return Work("LSTMs in training, float32", trained, examples, own, SIZES[:3], 1e-2)


def works() -> list[Work]:
    train, epochs = run()
    sea, road = sail(1200.0, seed=1, surface_s=600.0).log, sf.drive(216.0).log.select(IMU)
    follower = METHODS[FOLLOWER].build(sea.between(end_s=600.0), 0, SILENT).monitor
    fast = sf.fit(road.between(end_s=120.0), DEFAULT, held_out=0).monitor
    under = sea.between(600.0)
    return [
        replays(f"navigation, {EPOCHS} epochs", train, epochs, EPOCHS, 1.0, STEP_M),
        replays(f"followers, {RANGES} ranges", follower, under.between(end_s=float(under.time[99])), RANGES, 1.0, 20.0),
        replays(f"drives, {ROWS} samples", fast, road.between(120.0), ROWS, 0.01, 1.0),
        networks(),
    ]
