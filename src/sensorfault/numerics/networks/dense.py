"""Networks without memory, which get the whole window at once."""

import equinox as eqx
from jaxtyping import Array, Float

from sensorfault.numerics.networks.activations import ACTIVATIONS


class Dense(eqx.Module):
    """W x + b of one vector, or of the columns of a matrix."""

    weights: Float[Array, "D C"]
    bias: Float[Array, " D"]

    def __call__(self, x: Float[Array, "C *batch"]) -> Float[Array, "D *batch"]:
        return self.weights @ x + self.bias.reshape(-1, *(1 for _ in x.shape[1:]))


class Linear(eqx.Module):
    """A linear map of a window (s, C) to D outputs; if the window has the outputs' past, an autoregressive model."""

    output: Dense

    def __call__(self, window: Float[Array, "s C *batch"]) -> Float[Array, "D *batch"]:
        return self.output(window.reshape(-1, *window.shape[2:]))


class Mlp(eqx.Module):
    """Hidden layers f(W x + b) over a window (s, C), the oldest row first, and a linear output of D numbers."""

    hidden: tuple[Dense, ...]
    output: Dense
    activation: str = eqx.field(static=True, default="tanh")

    def __call__(self, window: Float[Array, "s C *batch"]) -> Float[Array, "D *batch"]:
        x = window.reshape(-1, *window.shape[2:])
        for layer in self.hidden:
            x = ACTIVATIONS[self.activation](layer(x))
        return self.output(x)
