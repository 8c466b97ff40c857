"""Long short-term memory: layers that read a window row by row."""

import equinox as eqx
import jax
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Float

from sensorfault.numerics.networks.dense import Dense


class LstmLayer(eqx.Module):
    """H cells in parallel; Hochreiter & Schmidhuber 1997 with the forget gate of Gers et al. 2000.

    The rows of the weights are those of the input gate i, the forget gate f, the cell input g and the output gate o,
    one after the other, H each.
    """

    inputs: Float[Array, "G C"]  # G = 4 H
    recurrent: Float[Array, "G H"]
    bias: Float[Array, " G"]

    def __call__(self, rows: Float[Array, "s C *batch"]) -> Float[Array, "s H *batch"]:
        """The cells' output after each row; a batch of windows stands on the last axis."""
        batch = rows.shape[2:]
        # W x + b of all rows in one product: nothing in it waits for the row before.
        drive = jnp.einsum("gc,sc...->sg...", self.inputs, rows) + self.bias.reshape(-1, *(1 for _ in batch))[None]

        def step(
            carry: tuple[Float[Array, "H *batch"], Float[Array, "H *batch"]], drive: Float[Array, "G *batch"]
        ) -> tuple[tuple[Float[Array, "H *batch"], Float[Array, "H *batch"]], Float[Array, "H *batch"]]:
            h, c = carry
            # i, f, o = sigmoid(W x + U h + b),  g = tanh(W x + U h + b)
            i, f, g, o = jnp.split(drive + self.recurrent @ h, 4)
            # c⁺ = f c + i g,  h⁺ = o tanh(c⁺)
            c = jax.nn.sigmoid(f) * c + jax.nn.sigmoid(i) * jnp.tanh(g)
            h = jax.nn.sigmoid(o) * jnp.tanh(c)
            return (h, c), h

        start = jnp.zeros((self.recurrent.shape[1], *batch), rows.dtype)
        told: Float[Array, "s H *batch"] = lax.scan(step, (start, start), drive)[1]
        return told


class Lstm(eqx.Module):
    """Layers of cells over a window (s, C), and a linear output of D numbers after the last row.

    Min et al. 2021, section 2.2: 8 inputs, two layers of 16, 2 outputs, a window of s = 30.
    """

    layers: tuple[LstmLayer, ...]
    output: Dense

    def __call__(self, window: Float[Array, "s C *batch"]) -> Float[Array, "D *batch"]:
        rows = window
        for layer in self.layers:
            rows = layer(rows)
        return self.output(rows[-1])
