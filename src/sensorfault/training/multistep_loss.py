"""The loss of the observer's networks: the errors of a roll-out, with larger weights on early steps."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float32, Int

from sensorfault.vehicles.height import MOST


class Weights(NamedTuple):
    """Weights of K networks with J steps each."""

    w: Float32[Array, "K J H V"]
    b: Float32[Array, "K J H"]
    v: Float32[Array, "K J H"]
    c: Float32[Array, "K J"]


class Windowed(NamedTuple):
    """Windows of L steps over T fixes: scaled height and inputs, and Δt in periods of the step that begins there."""

    height: Float32[Array, " T"]
    inputs: Float32[Array, "T U"]
    dt: Float32[Array, " T"]
    first: Int[Array, " W"]
    weight: Float32[Array, "K L"]  # of each step's error, of each network
    unit: Float32[Array, ""]  # spread of an increment, in halves of the height's range


def loss_of(
    weights: Weights, data: Windowed, first: Int[Array, " B"]
) -> tuple[Float32[Array, ""], Float32[Array, " K"]]:
    """Σ_j w_j (ĥ(k+j) - h(k+j))² over each network's steps, in spreads of an increment: mean over the windows."""
    many, longest = data.weight.shape
    at = first[None] + jnp.arange(longest + 1)[:, None]
    height, dt = data.height[at], data.dt[at]
    inputs = data.inputs[at[:-1]].transpose(0, 2, 1)  # [step, input, window]: windows fill the lanes
    shared = weights.c.shape[1] == 1

    def step(h: Array, row: tuple[Array, ...]) -> tuple[Array, Array]:
        j, x, dt, target = row
        w, b, v, c = (part[:, 0] if shared else part[:, j] for part in weights)
        low = jnp.clip(h, -MOST, MOST)
        hidden = jax.nn.relu(w[:, :, :1] * low[:, None] + w[:, :, 1:] @ x + b[:, :, None])
        h = h + data.unit * dt * ((v[:, :, None] * hidden).sum(axis=1) + c[:, None])
        return h, (((h - target) / data.unit) ** 2).mean(axis=1)

    rows = jnp.arange(longest), inputs, dt[:-1], height[1:]
    _, square = lax.scan(step, jnp.tile(height[0], (many, 1)), rows)
    # step weights N + 1 - j
    error = (data.weight.T * square).sum(axis=0)
    return error.sum(), error
