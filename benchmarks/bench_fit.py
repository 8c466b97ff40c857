"""Fitting the ELM autoencoder against training all weights of the same network by Adam.

Both learn from the same rows: the first 80 % of the first half of the drive. The rest of that half is the validation
block, the second half of the drive the test. Adam (the recipe bp-autoencoder's own training: optax, JAX, float32, an
epoch one compiled loop) starts from the ELM's hidden weights and stops when the validation error has not fallen for
PATIENCE epochs; its error is that of its best epoch. Compiling is not counted.

The fairest reading of "how much faster" has two ends, so both are printed: until Adam's validation error stops falling
(the bar; Adam is then the more accurate), and until it is first as low as the ELM's.
"""

import sys
from dataclasses import dataclass, replace
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np
from common import Bars, describe_machine, road_log, seconds

from sensorfault.calibration.scaling import Scaling
from sensorfault.training.backprop import train_copy
from sensorfault.training.elm import fit_elm
from sensorfault.training.gradient import Plan

HIDDEN, C = 32, 1e3
SEEDS = range(5)
PATIENCE = 100  # epochs
MOST = 20_000  # epochs
BAR = 100


@dataclass(frozen=True)
class Setting:
    """A batch size and a learning rate."""

    batch: int
    rate: float

    def __str__(self) -> str:
        return f"Adam, batches of {self.batch}, rate {self.rate:g}"


SETTINGS = (Setting(128, 0.003), Setting(64, 0.003), Setting(64, 0.01), Setting(32, 0.003))


class Rows(NamedTuple):
    """Scaled rows for training, validation and test."""

    train: np.ndarray
    validate: np.ndarray
    test: np.ndarray


class Trained(NamedTuple):
    compile_s: float
    fit_s: float
    reach_s: float  # until the ELM's validation error; inf if never
    epochs: int
    validation: float
    test: float


def rms(net: Any, x: np.ndarray) -> float:
    w, b, beta, offset = (np.asarray(part) for part in net)
    copy = 1 / (1 + np.exp(-(x @ w.T + b))) @ beta.T + offset
    return float(np.sqrt(np.mean((copy - x) ** 2)))


def elm_net(value: np.ndarray, scaling: Scaling, seed: int) -> Any:
    fitted = fit_elm(value, scaling, HIDDEN, C, seed)
    return fitted.weights, fitted.bias, fitted.output, fitted.offset


def run_adam(rows: Rows, setting: Setting, seed: int, target: float) -> Trained:
    """`target`: the ELM's validation error."""
    plan = Plan(epochs=MOST, batch=setting.batch, rate=setting.rate, patience=PATIENCE)
    start = perf_counter()
    train_copy(rows.train, HIDDEN, replace(plan, epochs=1), seed)
    compile_s = perf_counter() - start
    start = perf_counter()
    done = train_copy(rows.train, HIDDEN, plan, seed)
    fit_s = perf_counter() - start

    errors = np.sqrt(done.validated)
    there = np.flatnonzero(errors <= target)
    reach_s = (there[0] + 1) / len(errors) * fit_s if there.size else np.inf
    (layer,), output = done.net.hidden, done.net.output
    best = layer.weights, layer.bias, output.weights, output.bias
    return Trained(compile_s, fit_s, reach_s, len(errors), rms(best, rows.validate), rms(best, rows.test))


def spread(numbers: list[float]) -> str:
    return f"{np.median(numbers):.5f} ({min(numbers):.5f} to {max(numbers):.5f})"


def main() -> int:
    value = road_log().value
    half = value[: len(value) // 2]
    learn, scaling = half[: len(half) * 4 // 5], Scaling.of(half, np.ones(half.shape[1], bool))
    rows = Rows(scaling.to_unit(half), scaling.to_unit(half[len(learn) :]), scaling.to_unit(value[len(half) :]))
    describe_machine()

    elm_s = seconds(lambda: fit_elm(learn, scaling, HIDDEN, C), 101)
    nets = [elm_net(learn, scaling, seed) for seed in SEEDS]
    validation = [rms(net, rows.validate) for net in nets]
    test = [rms(net, rows.test) for net in nets]

    print(f"6-{HIDDEN}-6 on {len(learn)} rows; RMS errors in units of half the training range\n")
    print(f"{'':38}{'fit s':>9}{'as ELM s':>10}{'compile s':>11}{'epochs':>8}{'validation':>12}{'test':>10}")
    print(f"{'ELM (seed 0)':38}{np.median(elm_s):9.4f}{'':29}{validation[0]:12.5f}{test[0]:10.5f}")
    tried = {}
    for setting in SETTINGS:
        tried[setting] = done = run_adam(rows, setting, 0, validation[0])
        print(
            f"{setting!s:38}{done.fit_s:9.3f}{done.reach_s:10.3f}{done.compile_s:11.2f}{done.epochs:8d}"
            f"{done.validation:12.5f}{done.test:10.5f}{'  (still falling)' * (done.epochs == MOST)}"
        )

    rival = min(SETTINGS, key=lambda setting: tried[setting].reach_s)
    runs = [run_adam(rows, rival, seed, validation[seed]) for seed in SEEDS]
    fit_s, reach_s = (np.array([getattr(run, name) for run in runs]) for name in ("fit_s", "reach_s"))
    print(f"\nfor comparison, the first to reach the ELM's error: {rival}; {len(SEEDS)} seeds, median (least to most)")
    print(f"ELM   validation {spread(validation)}  test {spread(test)}")
    print(f"Adam  validation {spread([r.validation for r in runs])}  test {spread([r.test for r in runs])}")
    print(f"ELM   fit {np.median(elm_s) * 1e3:.2f} ms (best {elm_s.min() * 1e3:.2f})")
    print(f"Adam  fit {np.median(fit_s):.2f} s ({fit_s.min():.2f} to {fit_s.max():.2f})")
    print(
        f"Adam  as good as the ELM after {np.median(reach_s):.2f} s, {np.median(reach_s) / np.median(elm_s):.0f} fits"
    )
    ratio, least = (x / np.median(elm_s) for x in (np.median(fit_s), fit_s.min()))
    bars = Bars()
    bars.check(f"the ELM fits {ratio:.0f} times faster (fastest seed of Adam: {least:.0f}); bar {BAR}", ratio >= BAR)
    return bars.exit_code()


if __name__ == "__main__":
    sys.exit(main())
