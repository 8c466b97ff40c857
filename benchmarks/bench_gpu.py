"""Many runs at once on a GPU against all cores of the CPU: the same function, from NumPy to NumPy.

Faulty runs through the navigation (60 s, 100 inertial rows and nine satellites a second), followers with two leaders,
drives at 50 Hz through the default recipe, all in float64; and LSTMs in training. A CPU takes its share part by part,
so many at a time as stay in its cache, on a thread a core; one core's time is reckoned from one part. `there` is the
GPU's time without bringing the data there and back. Compiling is not counted, and printed.

`bench_gpu.py 1000` stops at that size.
"""

import sys
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from os import cpu_count
from typing import Any

import jax
import numpy as np
from common import Bars, describe_machine, seconds
from many import SIZES, Work, works

PART, TIMES = 50, 3


def on_cpu(work: Work, own: Any, count: int) -> tuple[float, float, Any]:
    """Time on one core and on all cores [s], and the output."""
    shared = jax.device_put(work.shared, jax.devices("cpu")[0])
    cores = cpu_count() or 1
    size = min(PART, -(-count // cores))
    at = np.arange(-(-count // size) * size).reshape(-1, size) % count
    parts = [jax.tree.map(lambda x, rows=rows: x[rows], own) for rows in at]

    def one(part: Any) -> Any:
        return jax.tree.map(np.asarray, work.run(shared, part))

    one(parts[0])  # compile
    alone = min(seconds(lambda: one(parts[0]), TIMES))
    with ThreadPoolExecutor(cores) as pool:
        together, result = best(lambda: list(pool.map(one, parts)))
    return alone * len(parts), together, jax.tree.map(lambda *xs: np.concatenate(xs)[:count], *result)


def on_gpu(work: Work, own: Any) -> tuple[float, float, float, Any]:
    """Times from NumPy to NumPy, on the device, and for compilation [s]; and the output."""
    gpu = jax.devices("gpu")[0]
    shared = jax.device_put(work.shared, gpu)

    def whole() -> Any:
        return jax.tree.map(np.asarray, work.run(shared, own))

    first = seconds(whole, 1)[0]
    took, result = best(whole)
    there = jax.device_put(own, gpu)
    return took, min(seconds(lambda: jax.block_until_ready(work.run(shared, there)), TIMES)), first - took, result


def best(work: Callable[[], Any]) -> tuple[float, Any]:
    """The shortest of several times [s], and the output."""
    result: list[Any] = []

    def once() -> None:
        result[:] = [work()]

    return min(seconds(once, TIMES)), result[0]


def agree(ours: Any, theirs: Any) -> tuple[float, float]:
    """Largest relative difference of runs with equal verdicts, and the share of runs with different verdicts."""
    numbers, *verdicts = jax.tree.leaves(ours)
    expected, *others = jax.tree.leaves(theirs)
    same = np.ones(len(numbers), bool)
    for a, b in zip(verdicts, others, strict=True):
        same &= (a == b).reshape(len(a), -1).all(axis=1)
    apart = np.nanmax(np.abs(numbers[same] - expected[same])) / np.nanmax(np.abs(expected))
    return float(apart), 1 - float(same.mean())


def compare(work: Work, most: int, bars: Bars) -> None:
    print(
        f"\n{work.name:30}{'one core s':>12}{'all cores s':>12}{'GPU s':>9}{'on it s':>9}{'times':>8}{'compiled s':>12}"
    )
    worth = ""
    for count in [size for size in work.sizes if size <= most]:
        own = work.own(count)
        core, cores, theirs = on_cpu(work, own, count)
        gpu, there, compiled, ours = on_gpu(work, own)
        row = f"{core:12.3f}{cores:12.3f}{gpu:9.3f}{there:9.3f}{cores / gpu:8.2f}{compiled:11.1f}"
        print(f"{count:30,}{row}", flush=True)
        apart, other = agree(ours, theirs)
        bars.check(
            f"they agree to {apart:.0e} (bar {work.agree:g}); verdicts differ in {other:.2%}", apart <= work.agree
        )
        worth = worth or (f"from {count:,} on" if gpu < cores else "")
    print(f"the GPU is worth it {worth}" if worth else "the GPU is not worth it at any of these sizes")


def main() -> int:
    try:
        gpu = jax.devices("gpu")[0]
    except RuntimeError:
        print("JAX sees no GPU: nothing to compare; where there is one, pip install 'jax[cuda13]'.")
        return 0
    describe_machine()
    print(f"GPU: {gpu.device_kind}")
    most = int(sys.argv[1]) if len(sys.argv) > 1 else max(SIZES)
    bars = Bars()
    with jax.default_device(jax.devices("cpu")[0]):
        every = works()
    for work in every:
        compare(work, most, bars)
    return bars.exit_code()


if __name__ == "__main__":
    sys.exit(main())
