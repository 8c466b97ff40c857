"""One live step of a follower with two leaders: predict, features, ANFIS, gate, update; and a fleet of a thousand.

Every row has a range to one leader and the leaders' positions, as under way. The peer in the same run is dynamax's
unscented filter, compiled, one follower and the filter alone: alpha 1, beta 0, kappa 0 make it the same cubature filter
(it adds 1e-9 to the diagonal of every covariance that it solves for; with that left out both agree to 1e-13 here).
"""

import sys
from collections.abc import Callable
from time import perf_counter, perf_counter_ns

import jax
import jax.numpy as jnp
import numpy as np
from common import Bars, describe_machine
from jax import lax

import sensorfault as sf
from sensorfault.core.monitor import Monitor
from sensorfault.methods.catalog import METHODS
from sensorfault.numerics.cubature import correct, observe, predict
from sensorfault.runtime.runners import Stepper, fleet, samples
from sensorfault.simulation.underwater import sail
from sensorfault.training.session import SILENT

ROUNDS, FLEET, STEPS = 8, 1000, 40
BAR_US, BAR_FLEET_US, BAR_AGREE = 60.0, 5.0, 1e-9
BEACONS = np.array([[300.0, 100.0], [-200.0, 250.0]])
METHOD = "anfis-cubature"


def pushed_us(fresh: Callable[[], sf.Live | Stepper], log: sf.Log) -> float:
    """Median of a push, of the fastest round [us]."""
    medians = []
    for _ in range(ROUNDS):
        live, took = fresh(), np.empty(len(log))
        for i, (time, row) in enumerate(zip(log.time, log.value, strict=True)):
            start = perf_counter_ns()
            live.push(time, row)
            took[i] = perf_counter_ns() - start
        medians.append(float(np.median(took[10:])) / 1e3)
    return min(medians)


def fleet_us(monitor: Monitor, log: sf.Log) -> float:
    """A sample of one of FLEET followers, compiled, of the fastest round [us]."""
    part = log.between(end_s=float(log.time[STEPS]))
    one = samples(part.time, part.value, part.fresh)
    rows = jax.tree.map(lambda x: jnp.broadcast_to(x[None], (FLEET, *x.shape)), one)
    states = jax.tree.map(lambda x: jnp.broadcast_to(jnp.asarray(x)[None], (FLEET, *jnp.shape(x))), monitor.init())
    run = jax.jit(lambda monitor, states, rows: fleet(monitor, states, rows, lambda r: r.verdict.sensor)[1])
    jax.block_until_ready(run(monitor, states, rows))
    took = []
    for _ in range(ROUNDS):
        start = perf_counter()
        jax.block_until_ready(run(monitor, states, rows))
        took.append(perf_counter() - start)
    return min(took) / (FLEET * STEPS) * 1e6


def peer() -> tuple[float, float, float]:
    """Ours and dynamax's time for one step of the bare filter in a replay [us], and how far apart they end."""
    from dynamax.nonlinear_gaussian_ssm import ParamsNLGSSM, UKFHyperParams, inference_ukf, unscented_kalman_filter

    inference_ukf.psd_solve = lambda a, b, **rest: jnp.linalg.solve(a, b)  # without the 1e-9
    rng, steps = np.random.default_rng(0), 2000
    beacons, r, q = jnp.asarray(BEACONS), jnp.full(2, 9.0), jnp.asarray([0.2, 0.2])

    def h(x: jax.Array) -> jax.Array:
        return jnp.sqrt(((x[None] - beacons) ** 2).sum(axis=1))

    z = jnp.asarray(np.asarray(h(jnp.zeros(2))) + 3 * rng.standard_normal((steps, 2)))

    @jax.jit
    def ours(z: jax.Array) -> jax.Array:
        def one(carry: tuple[jax.Array, jax.Array], z: jax.Array) -> tuple[tuple[jax.Array, jax.Array], jax.Array]:
            seen = observe(h, *carry)
            mean, root = correct(carry[0], seen, z - seen.expected, r, jnp.ones(2, bool))
            return predict(lambda x: x, mean, root, jnp.diag(jnp.sqrt(q))), mean

        return lax.scan(one, (jnp.zeros(2), jnp.eye(2)), z)[1]

    @jax.jit
    def theirs(z: jax.Array) -> jax.Array:
        params = ParamsNLGSSM(
            initial_mean=jnp.zeros(2),
            initial_covariance=jnp.eye(2),
            dynamics_function=lambda x: x,
            dynamics_covariance=jnp.diag(q),
            emission_function=h,
            emission_covariance=jnp.diag(r),
        )
        return unscented_kalman_filter(params, z, UKFHyperParams(alpha=1.0, beta=0.0, kappa=0.0)).filtered_means

    apart = float(jnp.abs(ours(z) - theirs(z)).max())
    times = []
    for run in (ours, theirs):
        took = []
        for _ in range(ROUNDS):
            start = perf_counter()
            jax.block_until_ready(run(z))
            took.append(perf_counter() - start)
        times.append(min(took) / steps * 1e6)
    return times[0], times[1], apart


def main() -> int:
    log = sail(1200.0, seed=1, surface_s=600.0).log
    model = METHODS[METHOD].build(log.between(end_s=600.0), 0, SILENT)
    under = log.between(600.0)
    bars = Bars()
    describe_machine()
    step, whole = (pushed_us(fresh, under) for fresh in (lambda: Stepper(model.monitor), lambda: sf.Live(model)))
    many = fleet_us(model.monitor, under)
    print(f"\nsensorfault.Live.push, which keeps the events beside the step: {whole:.1f} us")
    bars.check(f"a step of {METHOD} takes {step:.1f} us; bar {BAR_US:g}", step <= BAR_US)
    bars.check(f"a sample of one of {FLEET} takes {many:.2f} us; bar {BAR_FLEET_US:g}", many <= BAR_FLEET_US)
    try:
        ours, theirs, apart = peer()
    except ImportError:
        print("dynamax is not installed: pip install dynamax to compare with it")
        return bars.exit_code()
    print(f"the bare filter in a replay: ours {ours:.2f} us a step, dynamax {theirs:.2f} us")
    bars.check(f"filtered means agree to {apart:.1e} m; bar {BAR_AGREE:g}", apart <= BAR_AGREE)
    return bars.exit_code()


if __name__ == "__main__":
    sys.exit(main())
