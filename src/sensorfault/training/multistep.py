"""The network of the multi-step observer: one training for each number of steps, all in one computation."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
import optax
from jax import lax
from jaxtyping import Array, Bool, Float, Float32, Int

from sensorfault.logs.table import LogError
from sensorfault.training.fixes import Fixes
from sensorfault.training.multistep_loss import Weights, Windowed, loss_of
from sensorfault.vehicles.height import MOST, StepNetwork

HIDDEN = 10
LEAST = 40  # windows needed for training


@dataclass(frozen=True)
class Schedule:
    """The training schedule of Wang S. et al., section 2.1.

    Adam's `rate` is multiplied by `drop` after every `every` epochs; training ends after `patience` epochs without a
    new minimum of the training loss. `separate`: each step has its own weights, as in their figure 3; by default all
    steps share them.
    """

    epochs: int = 400
    batch: int = 32
    rate: float = 1e-3
    drop: float = 0.1
    every: int = 100
    patience: int = 10
    separate: bool = False


@dataclass(frozen=True)
class Trained:
    """Trained networks: `nets[s][m]` of seed s for the m-th number of steps.

    `loss`: of increments in units of their spread, after each epoch; NaN after the end of the training.
    """

    nets: tuple[tuple[StepNetwork, ...], ...]
    loss: Float[np.ndarray, "S M E"]


class _Now(NamedTuple):
    weights: Weights
    adam: Any
    best: Float32[Array, " K"]
    since: Int[Array, " K"]  # epochs since then
    going: Bool[Array, " K"]
    loss: Float32[Array, "E K"]
    epoch: Int[Array, ""]


_ADAM = optax.scale_by_adam()


def train_steps(
    fixes: Fixes, steps: Sequence[int], seeds: Sequence[int] = (0,), schedule: Schedule = Schedule()
) -> Trained:
    """Networks that predict the height over each of these numbers of steps; one training for each number and seed.

    Raises:
        LogError: too few consecutive fixes without a gap.
    """
    longest = max(steps)
    first = fixes.windows(longest)
    if len(first) < LEAST:
        raise LogError(
            f"{fixes.name} has {len(first)} runs of {longest} heights without a gap, but the multi-step observer "
            f"needs {LEAST}; give it more data, or data with fewer gaps."
        )
    center, half, unit = fixes.scale()
    weight = np.array([[max(n - j, 0) for j in range(longest)] for n in steps], float)
    weight /= weight.sum(axis=1, keepdims=True)  # of step j: N + 1 - j
    seen = (np.column_stack([fixes.height, fixes.inputs]) - center) / half
    data = Windowed(
        height=_f32(seen[:, 0]),
        inputs=_f32(np.clip(seen[:, 1:], -MOST, MOST)),
        dt=_f32(np.append(np.diff(fixes.time), 0.0) / fixes.period_s),
        first=jnp.asarray(first),
        weight=_f32(np.tile(weight, (len(seeds), 1))),
        unit=_f32(unit / half[0]),
    )
    sets = longest if schedule.separate else 1
    start = _start([(seed, n) for seed in seeds for n in steps], sets, len(center))
    weights, loss = _trained(data, start, schedule)
    parts = [np.asarray(x, float) for x in weights]

    def net(k: int) -> StepNetwork:
        w, b, v, c = (jnp.asarray(part[k]) for part in parts)
        c0, h0, u0, p0 = (jnp.asarray(x) for x in (center, half, unit, fixes.period_s))
        return StepNetwork(w, b, v, c, c0, h0, u0, p0, fixes.columns)

    nets = tuple(tuple(net(s * len(steps) + m) for m in range(len(steps))) for s in range(len(seeds)))
    losses = np.asarray(loss, float).T.reshape(len(seeds), len(steps), -1)
    return Trained(nets, losses)


def _f32(x: Any) -> Float32[Array, "..."]:
    return jnp.asarray(x, jnp.float32)


def _start(seeds: Sequence[tuple[int, int]], sets: int, inputs: int) -> Weights:
    """Hidden weights uniform in ±√(6 / (inputs + hidden)) (Glorot & Bengio 2010); the output predicts no change."""
    bound = np.sqrt(6 / (inputs + HIDDEN))
    w = [np.random.default_rng(seed).uniform(-bound, bound, (sets, HIDDEN, inputs)) for seed in seeds]
    nothing = np.zeros((len(seeds), sets, HIDDEN))
    return Weights(_f32(np.stack(w)), _f32(nothing), _f32(nothing), _f32(nothing[..., 0]))


@partial(jax.jit, static_argnums=2)
def _trained(data: Windowed, start: Weights, schedule: Schedule) -> tuple[Weights, Float32[Array, "E K"]]:
    """Train all networks together; a network whose training has ended no longer changes."""
    many, size = data.weight.shape[0], min(schedule.batch, data.first.size)

    def epoch(now: _Now) -> _Now:
        order = jax.random.permutation(jax.random.key(now.epoch), data.first)
        batches = order[: order.size // size * size].reshape(-1, size)
        rate = schedule.rate * schedule.drop ** (now.epoch // schedule.every).astype(jnp.float32)

        def batch(carry: tuple[Weights, Any], first: Int[Array, " B"]) -> tuple[tuple[Weights, Any], Array]:
            weights, adam = carry
            (_, error), slope = jax.value_and_grad(loss_of, has_aux=True)(weights, data, first)
            change, adam = _ADAM.update(slope, adam)

            def moved(w: Array, d: Array) -> Array:
                going = now.going.reshape(-1, *(1 for _ in w.shape[1:]))
                return jnp.where(going, w - rate * d, w)

            return (jax.tree.map(moved, weights, change), adam), error

        (weights, adam), errors = lax.scan(batch, (now.weights, now.adam), batches)
        loss = errors.mean(axis=0)
        better = loss < now.best
        since = jnp.where(better, 0, now.since + 1)
        losses = now.loss.at[now.epoch].set(jnp.where(now.going, loss, jnp.nan))
        going = now.going & (since < schedule.patience)
        return _Now(weights, adam, jnp.minimum(loss, now.best), since, going, losses, now.epoch + 1)

    end = lax.while_loop(
        lambda now: now.going.any() & (now.epoch < schedule.epochs),
        epoch,
        _Now(
            start,
            _ADAM.init(start),
            jnp.full(many, jnp.inf, jnp.float32),
            jnp.zeros(many, int),
            jnp.ones(many, bool),
            jnp.full((schedule.epochs, many), jnp.nan, jnp.float32),
            jnp.zeros((), int),
        ),
    )
    return end.weights, end.loss
