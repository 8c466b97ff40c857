"""One live step of the ELM monitor on six channels, against PyOD's PCA on one row.

Both are fitted on the first half of the drive and fed the second, row by row, in turns of ROUNDS rounds, so that both
meet the same load. PyOD's input is a ready (1, 6) array, its thread pools as they are or held to one, whichever is
faster. The bar is against PyOD as it comes, which scales its input as ours does. Printed beside it are its fastest
settings: scikit-learn's finiteness check off, and no scaling. It says a score; ours also judges channel, sensor and
sample, isolates, rebuilds and keeps the events.
"""

import sys
from dataclasses import replace
from itertools import product
from time import perf_counter_ns
from typing import NamedTuple

import numpy as np
import sklearn
from common import Bars, describe_machine, road_log
from pyod.models.pca import PCA
from threadpoolctl import threadpool_limits

import sensorfault as sf

ROUNDS = 8
BAR_US = 60.0
BAR_TIMES = 10


def time_pushes(live: sf.Live, log: sf.Log) -> np.ndarray:
    """Time of each push [us]."""
    took = np.empty(len(log))
    for i, (time, row) in enumerate(zip(log.time, log.value, strict=True)):
        start = perf_counter_ns()
        live.push(time, row)
        took[i] = perf_counter_ns() - start
    return took / 1e3


def time_pyod(detector: PCA, rows: np.ndarray) -> np.ndarray:
    took = np.empty(len(rows))
    for i in range(len(rows)):
        row = rows[i : i + 1]
        start = perf_counter_ns()
        detector.decision_function(row)
        took[i] = perf_counter_ns() - start
    return took / 1e3


class Rival(NamedTuple):
    """`finite`: scikit-learn assumes finite input. `threads`: for BLAS and OpenMP; None: the default."""

    detector: PCA
    scaled: bool
    finite: bool
    threads: int | None

    def __str__(self) -> str:
        scaled, checked = "scaled" if self.scaled else "unscaled", "unchecked" if self.finite else "checked"
        return f"PyOD PCA, {scaled}, {checked}, {self.threads or 'all'} thr."

    def run(self, rows: np.ndarray) -> np.ndarray:
        with sklearn.config_context(assume_finite=self.finite), threadpool_limits(self.threads):
            return time_pyod(self.detector, rows)


def rivals(train: np.ndarray) -> list[Rival]:
    detectors = {scaled: PCA(n_components=3, standardization=scaled).fit(train) for scaled in (True, False)}
    settings = product((True, False), (False, True), (None, 1))
    return [Rival(detectors[scaled], scaled, finite, threads) for scaled, finite, threads in settings]


def report(name: str, rounds: list[np.ndarray]) -> float:
    """Print one line; the median over all rounds [us]."""
    median, p95 = np.percentile(np.concatenate(rounds), [50, 95])
    print(f"{name:48}{median:9.1f}{p95:9.1f}{min(float(np.median(one)) for one in rounds):12.1f}")
    return float(median)


def main() -> int:
    log = road_log()
    middle = (log.time[0] + log.time[-1]) / 2
    train, test = log.between(end_s=middle), log.between(middle)
    live = sf.Live(sf.fit(train, "elm-autoencoder", held_out=0))
    peers = rivals(train.value)
    ours: list[np.ndarray] = []
    theirs: list[list[np.ndarray]] = [[] for _ in peers]
    describe_machine()
    for k in range(ROUNDS):
        later = replace(test, time=test.time + k * test.duration_s * 1.01)  # a live clock never goes back
        ours.append(time_pushes(live, later))
        for rounds, peer in zip(theirs, peers, strict=True):
            rounds.append(peer.run(test.value[:500]))

    print(f"\n{'us a sample':48}{'median':>9}{'p95':>9}{'best round':>12}")
    median = report("sensorfault.Live.push, elm-autoencoder", ours)
    took = [report(str(peer), rounds) for peer, rounds in zip(peers, theirs, strict=True)]
    usual = min(us for us, peer in zip(took, peers, strict=True) if peer.scaled and not peer.finite)
    print(f"{len(live.events)} events ended meanwhile, {len(live.open())} open\n")
    print(f"        {min(took) / median:.1f} times faster than PyOD PCA's fastest setting")
    bars = Bars()
    bars.check(f"Live.push takes {median:.1f} us, median; bar {BAR_US:g}", median <= BAR_US)
    bars.check(
        f"{usual / median:.1f} times faster than PyOD PCA as it comes; bar {BAR_TIMES}", usual / median >= BAR_TIMES
    )
    return bars.exit_code()


if __name__ == "__main__":
    sys.exit(main())
