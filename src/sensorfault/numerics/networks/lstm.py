"""Long short-term memory: layers of cells that read a window row by row."""

from typing import Any

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from sensorfault.numerics.networks.dense import Dense

Cells = tuple[Float[Array, "H *batch"], Float[Array, "H *batch"]]  # last output h, cell state c


class LstmLayer(eqx.Module):
    """H cells in parallel; Hochreiter & Schmidhuber 1997 with the forget gate of Gers et al. 2000.

    The rows of the weights are those of the input gate i, the forget gate f, the cell input g and the output gate o,
    one after the other, H each.
    """

    inputs: Float[Array, "G C"]  # G = 4 H
    recurrent: Float[Array, "G H"]
    bias: Float[Array, " G"]

    def start(self, like: Float[Array, "C *batch"]) -> Cells:
        """The cells before the first row."""
        nothing = jnp.zeros((self.recurrent.shape[1], *like.shape[1:]), like.dtype)
        return nothing, nothing

    def step(self, cells: Cells, x: Float[Array, "C *batch"]) -> Cells:
        """The cells after one more row."""
        h, c = cells
        bias = self.bias.reshape(-1, *(1 for _ in x.shape[1:]))
        # i, f, o = sigmoid(W x + U h + b),  g = tanh(W x + U h + b)
        i, f, g, o = jnp.split(self.inputs @ x + self.recurrent @ h + bias, 4)
        # c⁺ = f c + i g,  h⁺ = o tanh(c⁺)
        c = jax.nn.sigmoid(f) * c + jax.nn.sigmoid(i) * jnp.tanh(g)
        return jax.nn.sigmoid(o) * jnp.tanh(c), c


class Lstm(eqx.Module):
    """Layers of cells over a window (s, C), and a linear output of D numbers after the last row.

    Min et al. 2021, section 2.2: 8 inputs, two layers of 16, 2 outputs, a window of s = 30. A batch of windows stands
    on the last axis, where it fills the processor's lanes.
    """

    layers: tuple[LstmLayer, ...]
    output: Dense

    def __call__(self, window: Float[Array, "s C *batch"]) -> Float[Array, "D *batch"]:
        # All layers in one loop, the products with the inputs within: on two cores an epoch takes 0.7 times as long as
        # with one loop a layer and those products taken out of it, which pays by writing and reading all gates once.
        def step(cells: Any, x: Float[Array, "C *batch"]) -> tuple[Any, None]:
            after = []
            for layer, before in zip(self.layers, cells, strict=True):
                after.append(layer.step(before, x))
                x = after[-1][0]
            return tuple(after), None

        cells, x = [], window[0]
        for layer in self.layers:
            cells.append(layer.start(x))
            x = cells[-1][0]
        end, _ = lax.scan(step, tuple(cells), window)
        return self.output(end[-1][0])
