"""Novelty score of a single sample by local outlier factor against scikit-learn's score_samples, in one run.

A history of a thousand, k = 20: one feature (an innovation) and three (its means over three windows). A sample is
scored alone, as it comes live; beside it what the factor of nine satellites adds to a replay's step.
"""

import sys

import jax
import jax.numpy as jnp
import numpy as np
from common import Bars, describe_machine, seconds
from jax import lax
from sklearn.neighbors import LocalOutlierFactor

from sensorfault.training.outlier_factor import HISTORY, NEIGHBOURS, fit_history

TIMES, STEPS, SATELLITES = 1000, 400, 9
BAR_TIMES, BAR_AGREE = 20.0, 1e-6


def single(features: int, bars: Bars) -> None:
    rng = np.random.default_rng(features)
    points = rng.standard_t(4, (HISTORY, features))
    asked = rng.standard_t(4, (TIMES, 1, features))
    peers = {a: LocalOutlierFactor(n_neighbors=NEIGHBOURS, novelty=True, algorithm=a) for a in ("auto", "brute")}
    history = fit_history(points, 0)
    score = jax.jit(lambda asked: history.outlier_factor(asked))
    np.asarray(score(asked[0]))  # compile
    took = np.median([seconds(lambda one=one: np.asarray(score(one)), 1)[0] for one in asked])
    theirs = {}
    for name, peer in peers.items():
        peer.fit(points)
        theirs[name] = np.median([seconds(lambda one=one, p=peer: p.score_samples(one), 1)[0] for one in asked])
    name = min(theirs, key=lambda name: theirs[name])
    ratio = theirs[name] / took
    apart = float(np.abs(np.asarray(score(asked[:, 0])) / -peers[name].score_samples(asked[:, 0]) - 1).max())
    print(f"\n{features} feature(s): {took * 1e6:.1f} us, scikit-learn ({name}) {theirs[name] * 1e6:.0f} us")
    bars.check(f"{ratio:.0f} times faster; bar {BAR_TIMES:g}", ratio >= BAR_TIMES)
    bars.check(f"they agree to {apart:.0e}; bar {BAR_AGREE:g}", apart <= BAR_AGREE)
    rows = jnp.asarray(rng.standard_t(4, (STEPS, SATELLITES, features)))
    step = jax.jit(lambda rows: lax.scan(lambda s, row: (s, history.outlier_factor(row)), 0.0, rows)[1])
    jax.block_until_ready(step(rows))
    each = min(seconds(lambda: jax.block_until_ready(step(rows)), 20)) / STEPS * 1e6
    print(f"{SATELLITES} satellites in a replay: {each:.1f} us a step")


def main() -> int:
    describe_machine()
    bars = Bars()
    for features in (1, 3):
        single(features, bars)
    return bars.exit_code()


if __name__ == "__main__":
    sys.exit(main())
