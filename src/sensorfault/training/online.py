"""A network that learns while it watches: how it begins, and what it is taught beforehand in the same way."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Float

from sensorfault.core.types import Sample, Trust
from sensorfault.logs.table import Log
from sensorfault.numerics.networks.dense import Mlp
from sensorfault.runtime.runners import samples
from sensorfault.stages.residual.online_network import OnlineNetwork
from sensorfault.training.gradient import Plan, train
from sensorfault.training.initial import new_mlp
from sensorfault.training.session import Session
from sensorfault.training.windows import Windows

GAP = 1.5  # ticks without a row that break a window
EXACT = 0.5  # of the noise of an increment: what is foretold so well is not learned from


@dataclass(frozen=True)
class Learning:
    """`hidden` units; `delays` (m, n), `rate`, `iterations`, `absolute` and `warm` as in OnlineNetwork.

    Rate and iterations are such that a sample moves its own prediction by about a third of the error: what is learned
    to convergence is learned with its noise. Beforehand the network is trained on the healthy log by `plan`. With
    `scratch`, as printed, it begins knowing nothing all the same, and nothing is valid before `warm` samples in a row
    have been foretold within their limits.
    """

    hidden: int = 5
    delays: tuple[int, int] = (1, 1)
    rate: float = 0.1
    iterations: int = 3
    absolute: bool = False
    scratch: bool = False
    warm: int = 10
    plan: Plan = field(default_factory=lambda: Plan(rate=3e-3))


def learner(
    log: Log,
    columns: tuple[int, ...],
    driven: tuple[int, ...],
    learning: Learning,
    seed: int,
    session: Session,
) -> OnlineNetwork:
    """The network for these outputs and inputs: scaled by the extremes of the healthy log, and taught on it.

    It begins with random weights, but foretelling no change (or, if `absolute`, the middle of the range).
    """
    (m, n), outputs = learning.delays, len(columns)
    seen = log.value[:, [*columns, *driven]]
    low, high = np.nanmin(seen, axis=0), np.nanmax(seen, axis=0)
    new = OnlineNetwork(
        network=_new(learning.hidden, outputs * m + len(driven) * (n + 1), outputs, seed),
        center=jnp.asarray((low + high) / 2),
        half=jnp.asarray((high - low) / 2),
        step=jnp.asarray(steps(log, columns)),
        cov=jnp.eye(len(log.channels)),
        tolerance=jnp.asarray(EXACT * np.sqrt(2) * noise(log.value[:, columns])),
        settled=jnp.zeros(outputs),
        rate=jnp.asarray(learning.rate),
        warm=jnp.asarray(0.0),
        gap_s=jnp.asarray(GAP * log.period_s),
        columns=columns,
        driven=driven,
        delays=learning.delays,
        iterations=learning.iterations,
        absolute=learning.absolute,
    )
    found = train(new.network, _examples(replace(new, iterations=0), log), learning.plan, seed, session)
    return replace(new, network=found.net)


def untrained(residual: OnlineNetwork, limit: Float[np.ndarray, " C"], warm: int, seed: int) -> OnlineNetwork:
    """The same knowing nothing, and unsure before `warm` samples in a row have been foretold within their limits."""
    (inner,), outputs = residual.network.hidden, list(residual.columns)
    hidden, inputs = inner.weights.shape
    network = _new(hidden, inputs, len(outputs), seed)
    return replace(residual, network=network, settled=jnp.asarray(limit[outputs]), warm=jnp.asarray(float(warm)))


def noise(value: Float[np.ndarray, "T D"]) -> Float[np.ndarray, " D"]:
    """Standard deviation of each channel's noise [SI]: of what no smooth motion explains, by third differences.

    White noise of variance s² has third differences of variance 20 s²; their median size is not moved by a few jumps.
    """
    rough = np.abs(np.diff(value, 3, axis=0))
    return np.asarray(np.nanmedian(rough, axis=0) / 0.6745 / np.sqrt(20))


def steps(log: Log, columns: Sequence[int]) -> Float[np.ndarray, " D"]:
    """The largest change of each of these channels from one tick to the next [SI]."""
    together = np.diff(log.time)[:, None] <= GAP * log.period_s
    change = np.where(together, np.abs(np.diff(log.value[:, columns], axis=0)), np.nan)
    return np.asarray(np.nanmax(change, axis=0))


def _new(hidden: int, inputs: int, outputs: int, seed: int) -> Mlp:
    network = new_mlp(seed, inputs, outputs, (hidden,))
    return replace(network, output=jax.tree.map(jnp.zeros_like, network.output))


def _examples(residual: OnlineNetwork, log: Log) -> Windows:
    """What the network sees before each healthy row, each a window of one row, and what it should say to that."""

    @jax.jit
    def all_of(residual: OnlineNetwork, rows: Sample) -> tuple[Array, Array, Array]:
        def one(state: Any, sample: Sample) -> tuple[Any, tuple[Array, Array, Array]]:
            _, pending = residual.evaluate(state, sample)
            there = sample.fresh
            trust = Trust(sample.value, there, there & False, there, sample.born)
            return residual.update(pending, trust), (pending.x, *residual.lesson(pending, trust))

        return lax.scan(one, residual.init(), rows)[1]

    x, target, teaches = map(np.asarray, all_of(residual, samples(log.time, log.value, log.fresh)))
    whole = teaches.all(axis=1)
    return Windows(x[whole], np.arange(whole.sum()), target[whole], 1)
