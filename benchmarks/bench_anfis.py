"""Hybrid training of an ANFIS against anfis-toolbox, and the cost of one inference in a follower's step.

Both learn the size of a range's error from the three features of its innovation, on simulated missions: two bell
functions an input, all eight rules, the same bells to begin with, the same penalty on the consequents, EPOCHS epochs.
Steps differ in kind (ours have a length, Jang's; anfis-toolbox has a rate), so each has the one of STEPS or RATES that
leaves the least error. In turns, ROUNDS times, and the fastest of each counts. Printed beside it is the error on
missions that neither has seen, where one leader's ranges of one mission are few for 32 consequents.
"""

import sys
from time import perf_counter
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from anfis_toolbox import ANFISRegressor
from anfis_toolbox.membership import BellMF
from common import Bars, describe_machine, seconds

from sensorfault.methods.ranging.range_filter import Filter, cubature, followed, monitor
from sensorfault.numerics.fuzzy import Anfis
from sensorfault.numerics.innovation import features
from sensorfault.training.fuzzy import Setting, fit_anfis
from sensorfault.training.labelled import Labelled, unit_range
from sensorfault.training.partition import grid
from sensorfault_studies.xu2023.run import through
from sensorfault_studies.xu2023.scenario import TRAINED_S, scenario

EPOCHS, ROUNDS, PENALTY = 100, 2, 1e-6
STEPS, RATES = (0.003, 0.01, 0.03, 0.1), (1e-5, 1e-4, 1e-3, 1e-2)
BAR_TIMES, BAR_US = 5, 5.0
FOLLOWERS, LEADERS = 1000, 2


class Learned(NamedTuple):
    fit_s: float
    rmse: float
    unseen: float


def ranges(seeds: range, leaders: tuple[int, ...], until_s: float) -> Labelled:
    """Features and errors of these leaders' ranges in the first seconds of so many missions."""
    features_of, errors = [], []
    for seed in seeds:
        case = scenario(seed)
        found = followed("bench", case.log)
        result = through(monitor(case.log, cubature(case.log, found, Filter())), case).residual
        for j in leaders:
            c = found.leaders[j].range
            there = result.valid[:, c] & ~np.isnan(case.error[:, j]) & (case.log.time < until_s)
            seen = (x[there] for x in (result.value[:, c], result.cov[:, c, c], result.noise[:, c]))
            features_of.append(features(*seen))
            errors.append(np.abs(case.error[there, j]))
    return Labelled(np.concatenate(features_of), np.concatenate(errors))


def rms(x: np.ndarray) -> float:
    return float(np.sqrt(np.mean(x**2)))


def ours(seen: Labelled, unseen: Labelled, step: float) -> Learned:
    start = perf_counter()
    result = fit_anfis(*seen, Setting(step=step, epochs=EPOCHS, reach=0.0, ridge=PENALTY / len(seen.target)))
    fit_s = perf_counter() - start
    model = jax.tree.map(np.asarray, result.model)
    return Learned(fit_s, result.rmse, rms(model(unseen.features) - unseen.target))


def theirs(seen: Labelled, unseen: Labelled, rate: float) -> Learned:
    begin, unit = grid(3, 2), unit_range(seen.features)
    bells = [
        {"membership_functions": [BellMF(begin.width[p], begin.slope[p], begin.center[p]) for p in (2 * i, 2 * i + 1)]}
        for i in range(3)
    ]
    x = unit(seen.features)
    peer = ANFISRegressor(
        inputs_config=dict(enumerate(bells)), optimizer="hybrid", learning_rate=rate, epochs=EPOCHS, n_mfs=2
    )
    start = perf_counter()
    peer.fit(x, seen.target)
    fit_s = perf_counter() - start
    errors = [rms(peer.predict(unit(one.features)) - one.target) for one in (seen, unseen)]
    return Learned(fit_s, *errors)


def training(name: str, seen: Labelled, unseen: Labelled, bars: Bars) -> None:
    rows = len(seen.target)
    step = min(STEPS, key=lambda step: ours(seen, unseen, step).rmse)
    rate = min(RATES, key=lambda rate: theirs(seen, unseen, rate).rmse)
    ran = [(ours(seen, unseen, step), theirs(seen, unseen, rate)) for _ in range(ROUNDS)]
    mine, peer = (min(one, key=lambda run: run.fit_s) for one in zip(*ran, strict=True))
    print(f"\n{f'{name}, {rows} rows':36}{'fit ms':>9}{'RMSE m':>9}{'unseen m':>10}")
    for name, one in ((f"sensorfault, step {step:g}", mine), (f"anfis-toolbox, rate {rate:g}", peer)):
        print(f"{name:36}{one.fit_s * 1e3:9.1f}{one.rmse:9.4f}{one.unseen:10.4f}")
    ratio = peer.fit_s / mine.fit_s
    bars.check(f"{rows} rows: {ratio:.1f} times faster than anfis-toolbox; bar {BAR_TIMES}", ratio >= BAR_TIMES)
    bars.check(f"{rows} rows: RMSE {mine.rmse:.4f} m, no worse than {peer.rmse:.4f}", mine.rmse <= peer.rmse)


def inference(model: Anfis, features: np.ndarray, bars: Bars) -> None:
    """Time that one inference adds to a compiled step, and to each follower of a fleet."""
    fleet = jax.jit(jax.vmap(model))
    all_of = jnp.asarray(features)
    jax.block_until_ready(fleet(all_of))
    each = min(seconds(lambda: jax.block_until_ready(fleet(all_of)), 50)) / (len(features) / LEADERS) * 1e6
    one, nothing = jax.jit(model.__call__), jax.jit(lambda x: 2 * x)
    np.asarray(one(features[0])), np.asarray(nothing(features[0]))
    took = [np.median(seconds(lambda f=f: np.asarray(f(features[0])), 2000)) * 1e6 for f in (one, nothing)]
    print(f"\none live inference {took[0]:.1f} us, {took[0] - took[1]:.1f} more than a call that computes nothing")
    bars.check(
        f"a fleet of {len(features) // LEADERS}, {LEADERS} leaders: {each:.2f} us a follower; bar {BAR_US:g}",
        each <= BAR_US,
    )


def main() -> int:
    describe_machine()
    bars = Bars()
    one, pooled = ranges(range(1), (0,), TRAINED_S), ranges(range(8), (0, 1), TRAINED_S)
    unseen = ranges(range(8, 12), (0, 1), np.inf)
    training("one leader", one, unseen, bars)
    training("eight missions", pooled, unseen, bars)
    inference(fit_anfis(*one).model, unseen.features[: FOLLOWERS * LEADERS], bars)
    return bars.exit_code()


if __name__ == "__main__":
    sys.exit(main())
