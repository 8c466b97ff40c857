"""One GNSS/INS run, and a thousand faulty runs at once against the same loop in NumPy.

The run: 413 s of a simulated train, 100 inertial rows and nine satellites a second. The nominal state goes with every
row, the covariance twice a second. Compiling is not counted. The campaign: the last EPOCHS of that run, a step of 15 m
on one satellite from a different epoch on in each, noise of its own in each; innovations over LIMIT deviations are left
out, largest first, up to three. NumPy does the same, run by run, row by row, satellite after satellite, from the same
state; a few of its runs are timed, and their innovations compared with ours, so that it is the same computation.
"""

import sys
from functools import partial
from time import perf_counter

import jax
import jax.numpy as jnp
import numpy as np
from common import Bars, describe_machine, seconds
from navigator import navigate

from sensorfault.core.monitor import Branch, Monitor, MonitorState
from sensorfault.core.types import Report
from sensorfault.core.verdicts import FAULT
from sensorfault.logs.epochs import framing
from sensorfault.logs.table import Log
from sensorfault.methods.gnss.gnss_ins import Filter, monitor, navigation
from sensorfault.numerics.alignment import ALIGNED
from sensorfault.runtime.replay import replay_log
from sensorfault.runtime.runners import replay, samples
from sensorfault.simulation import pseudorange
from sensorfault.simulation.ride import recorded
from sensorfault.simulation.train import ride
from sensorfault.stages.statistic.normalised import Normalised
from sensorfault.stages.threshold.fixed import Fixed

RUN_S, SATELLITES, LIMIT, STEP_M = 413.0, 9, 5.0, 15.0
EPOCHS, RUNS, TOGETHER, PEERS = 60, 1000, 50, 3
BAR_S, BAR_TIMES = 0.5, 50.0


def run() -> tuple[Monitor, Log]:
    """The monitor and the epochs, nine satellites received all the time."""
    true = ride(RUN_S, seed=1, noise="gaussian")
    high = np.argsort(-true.sky.elevation.mean(axis=0))[:SATELLITES]
    sky = true.sky.only(np.isin(np.arange(len(true.sky.names)), high))
    error = pseudorange.errors("gaussian", [1], sky.elevation)[0]
    inertial = true.log.value[:, :6]
    log = recorded("bench", true.log.time, inertial, true.epochs, sky, true.clock, error, 0 * error)
    how = framing(log, sky.names, False)
    limit = Branch(Normalised(), Fixed(LIMIT * jnp.ones(SATELLITES)))
    return monitor(how, navigation(how, Filter()), limit), how.frame(log)


def kept(report: Report) -> tuple[jax.Array, jax.Array]:
    return report.residual.value, report.verdict.channel == FAULT


def faulty(epochs: Log) -> np.ndarray:
    """Pseudoranges of all runs, (N, E, S)."""
    random = np.random.default_rng(0)
    value = epochs.value + random.standard_normal((RUNS, *epochs.value.shape))
    for i, one in enumerate(value):
        one[5 + i % (EPOCHS // 2) :, i % SATELLITES] += STEP_M
    return value


def campaign(own: Monitor, start: MonitorState, epochs: Log, value: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Time of all runs [s], and their output."""
    rows = samples(epochs.time, epochs.value, epochs.fresh, epochs.block)

    @jax.jit
    def together(own: Monitor, start: MonitorState, value: jax.Array) -> tuple[jax.Array, jax.Array]:
        return jax.vmap(lambda one: replay(own, start, rows._replace(value=one), kept)[1])(value)

    parts = [jnp.asarray(value[i : i + TOGETHER]) for i in range(0, len(value), TOGETHER)]
    jax.block_until_ready(together(own, start, parts[0]))
    begin = perf_counter()
    result = [jax.block_until_ready(together(own, start, part)) for part in parts]
    took = perf_counter() - begin
    innovation, flagged = (np.concatenate([np.asarray(x) for x in xs]) for xs in zip(*result, strict=True))
    return took, innovation, flagged


def main() -> int:
    describe_machine()
    bars = Bars()
    own, epochs = run()
    replay_log(own, epochs)
    once = float(np.median(seconds(partial(replay_log, own, epochs), 5)))
    print(
        f"\n{RUN_S:.0f} s, {len(epochs)} epochs of {SATELLITES} satellites, inertial rows at 100 Hz, covariance at 2 Hz"
    )
    bars.check(f"replayed in {once:.2f} s; bar {BAR_S:g}", once <= BAR_S)

    first = len(epochs) - EPOCHS
    rows = samples(epochs.time, epochs.value, epochs.fresh, epochs.block)
    before = jax.tree.map(lambda x: x[:first], rows)
    start, _ = jax.jit(partial(replay, keep=kept))(own, own.init(), before)
    assert start.residual.phase == ALIGNED
    part = epochs.between(float(epochs.time[first]) - 1e-6)
    value = faulty(part)
    ours, innovation, flagged = campaign(own, start, part, value)
    belief = jax.tree.map(np.asarray, start.residual)
    begin = perf_counter()
    result = [navigate(belief, part.block, one, LIMIT) for one in value[:PEERS]]
    peer = (perf_counter() - begin) / PEERS
    apart = max(np.abs(innovation[i] - one).max() for i, (one, _) in enumerate(result))
    same = all((flagged[i] == out).all() for i, (_, out) in enumerate(result))
    print(f"\n{'one run of ' + str(EPOCHS) + ' epochs':36}{'ms':>9}{'of 1000, s':>12}")
    for name, took in (("sensorfault, in a campaign", ours / RUNS), ("NumPy, row by row", peer)):
        print(f"{name:36}{took * 1e3:9.2f}{took * 1e3:12.2f}")
    bars.check(f"the same: innovations to {apart:.1e} m, the same left out: {same}", same and apart < 1e-6)
    ratio = peer / (ours / RUNS)
    bars.check(f"{RUNS} faulty runs {ratio:.0f} times faster than NumPy; bar {BAR_TIMES:g}", ratio >= BAR_TIMES)
    return bars.exit_code()


if __name__ == "__main__":
    sys.exit(main())
