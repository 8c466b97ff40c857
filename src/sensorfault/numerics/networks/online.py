"""Backpropagation of one sample at a time, repeated until its error is small."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float, Int

from sensorfault.numerics.networks.dense import Dense, Mlp

_Round = tuple[Mlp, Float[Array, " D"], Float[Array, " L"], Int[Array, ""]]


def taught(
    network: Mlp,
    x: Float[Array, " N"],
    target: Float[Array, " D"],
    teaches: Bool[Array, " D"],
    tolerance: Float[Array, " D"],
    rate: Float[Array, ""],
    most: int,
) -> Mlp:
    """The network of one hidden layer of tanh after this sample: at most `most` steps down its squared error.

    Only the part beyond `tolerance` is an error, and only outputs that teach have one. The step is normalised: 1 is
    the longest step that moves no output beyond its target, to first order.
    """

    def off(network: Mlp) -> tuple[Float[Array, " D"], Float[Array, " L"]]:
        (hidden,) = network.hidden
        h = jnp.tanh(hidden(x))
        e = target - network.output(h)
        return jnp.where(teaches, e - jnp.clip(e, -tolerance, tolerance), 0.0), h

    def more(carry: _Round) -> Bool[Array, ""]:
        _, e, _, rounds = carry
        return (e != 0).any() & (rounds < most)

    def step(carry: _Round) -> _Round:
        network, e, h, rounds = carry
        (hidden,) = network.hidden
        v = network.output.weights * (1 - h**2)[None]  # ∂o/∂a, with a = W x + b and h = tanh(a)
        # η = rate / ‖∂o/∂(W, b, V, c)‖², of which (1 + |h|²) is each output's own share
        eta = rate / (1 + (h**2).sum() + (1 + (x**2).sum()) * (v**2).sum())
        # V⁺ = V + η e h',  c⁺ = c + η e,  W⁺ = W + η (v' e) x',  b⁺ = b + η v' e
        back = eta * (v * e[:, None]).sum(axis=0)
        e = eta * e
        output = Dense(network.output.weights + e[:, None] * h[None], network.output.bias + e)
        inner = Dense(hidden.weights + back[:, None] * x[None], hidden.bias + back)
        after = Mlp((inner,), output, network.activation)
        return after, *off(after), rounds + 1

    start = network, *off(network), jnp.zeros((), jnp.int32)
    return lax.while_loop(more, step, start)[0]
