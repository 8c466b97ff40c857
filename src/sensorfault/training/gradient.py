"""Training by gradient: Adam on shuffled batches until the error on rows not learned from stops falling.

An epoch is one compiled scan. What the chances are in an epoch follows from the seed and its number alone, so that a
training that goes on from a checkpoint ends where it would have ended without the break, to the bit.
"""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any, Generic, NamedTuple, TypeVar

import jax
import jax.numpy as jnp
import numpy as np
import optax
from jax import lax
from jaxtyping import Array, Float32, Int32

from sensorfault.logs.table import LogError
from sensorfault.training.checkpoint import Checkpoint
from sensorfault.training.session import SILENT, Session
from sensorfault.training.windows import OnDevice, Windows

LEAST = 20  # windows on each side of the split
CHUNK = 1024  # windows judged at a time

Net = TypeVar("Net", bound=Callable[..., Any])


@dataclass(frozen=True)
class Plan:
    """How to train: `epochs` at most; `patience`: epochs without a lower validation error before it ends.

    `validation`: share of the windows, the last ones in time, that are not learned from. `rate` is Adam's; it is
    multiplied by `slower` whenever half of the patience is used up.
    """

    epochs: int = 300
    batch: int = 64
    rate: float = 1e-3
    patience: int = 30
    validation: float = 0.2
    slower: float = 0.3


@dataclass(frozen=True)
class Trained(Generic[Net]):
    """The network of the epoch with the lowest validation error (mean square, (12)), and all errors by epoch."""

    net: Net
    best_epoch: int
    learned: tuple[float, ...]
    validated: tuple[float, ...]


def train(net: Net, windows: Windows, plan: Plan, seed: int, session: Session = SILENT) -> Trained[Net]:
    """Minimise the mean square error of `net` on the windows. Min et al. 2021, equation (12).

    Raises:
        LogError: too few windows, or a checkpoint of another training.
    """
    learn, validate = split(windows, plan.validation)
    examples, unseen = learn.on_device(), validate.on_device()
    size = min(plan.batch, len(learn.first))
    now = begin(net, plan.rate)
    saved = Checkpoint.of(session.checkpoint, now, (now, tuple(windows), plan, seed))
    now, learned, validated = saved.resumed(now)
    best = int(np.argmin(validated)) + 1 if validated else 0
    while len(validated) < plan.epochs and len(validated) - best < plan.patience:
        epoch = len(validated) + 1
        order = np.random.default_rng((seed, epoch)).permutation(len(learn.first))
        batches = order[: len(order) // size * size].reshape(-1, size).astype(np.int32)
        now, error = one_epoch(now, examples, jnp.asarray(batches), windows.length)
        learned.append(float(error))
        validated.append(float(_error(now.net, unseen, windows.length)))
        if not best or validated[-1] < validated[best - 1]:
            best, now = epoch, now._replace(best=now.net)
        elif (epoch - best) % max(plan.patience // 2, 1) == 0:
            now = now._replace(rate=now.rate * plan.slower)
        session.progress(f"epoch {epoch} of at most {plan.epochs}, validation error {np.sqrt(validated[-1]):.3g}")
        saved.write(now, learned, validated)
    found = jax.tree.map(lambda x: jnp.asarray(x, float), now.best)
    return Trained(found, best, tuple(learned), tuple(validated))


def split(windows: Windows, share: float) -> tuple[Windows, Windows]:
    """The first windows to learn from, and the last `share` of them to stop by, with one window left out between.

    Raises:
        LogError: too few windows.
    """
    order = np.argsort(windows.first, kind="stable")
    cut = round(len(order) * (1 - share))
    start = windows.first[order[min(cut, len(order) - 1)]] if len(order) else 0
    # The last row that a window asks for is the one after it; a whole window lies between it and the first one judged.
    before = order[windows.first[order] + 2 * windows.length < start]
    after = order[cut:]
    if min(len(before), len(after)) < LEAST:
        raise LogError(
            f"{len(order)} windows of {windows.length} rows are too few to learn from, {len(before)} besides "
            f"{len(after)} to stop by, where {LEAST} of each are needed; give a longer log."
        )
    learn, judge = (
        windows._replace(first=windows.first[rows], target=windows.target[rows]) for rows in (before, after)
    )
    return learn, judge


class Now(NamedTuple):
    """Where a training stands; all of it in float32."""

    net: Any
    optimiser: Any
    best: Any
    rate: Float32[Array, ""]


_ADAM = optax.scale_by_adam()


def begin(net: Any, rate: float) -> Now:
    """A training before its first epoch."""
    net = jax.tree.map(lambda x: jnp.asarray(x, jnp.float32), net)
    return Now(net, _ADAM.init(net), net, jnp.asarray(rate, jnp.float32))


def _loss(net: Callable[..., Any], x: Float32[Array, "s C B"], y: Float32[Array, "D B"]) -> Float32[Array, " B"]:
    # (12) L = mean (y - y~)²
    square: Float32[Array, " B"] = ((net(x) - y) ** 2).mean(axis=0)
    return square


@partial(jax.jit, static_argnums=3)
def one_epoch(
    now: Now, examples: OnDevice, batches: Int32[Array, "K B"], length: int
) -> tuple[Now, Float32[Array, ""]]:
    """One pass over the batches: the training after it, and the mean error met on the way."""

    def step(carry: tuple[Any, Any], chosen: Int32[Array, " B"]) -> tuple[tuple[Any, Any], Float32[Array, ""]]:
        net, state = carry
        x, y = examples.batch(chosen, length)
        error, slope = jax.value_and_grad(lambda net: _loss(net, x, y).mean())(net)
        change, state = _ADAM.update(slope, state, net)
        net = jax.tree.map(lambda w, d: w - now.rate * d, net, change)
        return (net, state), error

    (net, state), errors = lax.scan(step, (now.net, now.optimiser), batches)
    return now._replace(net=net, optimiser=state), errors.mean()


@partial(jax.jit, static_argnums=2)
def _error(net: Callable[..., Any], unseen: OnDevice, length: int) -> Float32[Array, ""]:
    """Mean square error over all windows, a chunk at a time."""
    count = unseen.first.shape[0]
    chunks = -(-count // CHUNK)
    at = jnp.arange(chunks * CHUNK, dtype=jnp.int32)
    chosen, weight = jnp.minimum(at, count - 1), (at < count).astype(jnp.float32)

    def judge(part: tuple[Int32[Array, " B"], Float32[Array, " B"]]) -> Float32[Array, ""]:
        return (_loss(net, *unseen.batch(part[0], length)) * part[1]).sum()

    sums = lax.map(judge, (chosen.reshape(chunks, -1), weight.reshape(chunks, -1)))
    mean: Float32[Array, ""] = sums.sum() / count
    return mean
