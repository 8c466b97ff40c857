"""Networks before training, with random weights of the usual size."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax.numpy as jnp
import numpy as np

from sensorfault.numerics.networks.dense import Dense, Linear, Mlp
from sensorfault.numerics.networks.lstm import Lstm, LstmLayer

Network = Linear | Mlp | Lstm


def _dense(random: np.random.Generator, inputs: int, outputs: int) -> Dense:
    """Uniform in ±√(6 / (inputs + outputs)) (Glorot & Bengio 2010), biases at 0."""
    bound = np.sqrt(6 / (inputs + outputs))
    return Dense(jnp.asarray(random.uniform(-bound, bound, (outputs, inputs))), jnp.zeros(outputs))


def _layer(random: np.random.Generator, inputs: int, cells: int) -> LstmLayer:
    """Uniform in ±1/√cells; the forget gate opened by a bias of 1 (Jozefowicz et al. 2015)."""
    bound = 1 / np.sqrt(cells)
    gates = 4 * cells
    return LstmLayer(
        jnp.asarray(random.uniform(-bound, bound, (gates, inputs))),
        jnp.asarray(random.uniform(-bound, bound, (gates, cells))),
        jnp.asarray(np.repeat((0.0, 1.0, 0.0, 0.0), cells)),
    )


def new_lstm(seed: int, inputs: int, outputs: int, cells: tuple[int, ...] = (16, 16)) -> Lstm:
    """An LSTM with `cells` in each layer."""
    random = np.random.default_rng(seed)
    widths = (inputs, *cells)
    layers = tuple(_layer(random, into, size) for into, size in zip(widths, cells, strict=False))
    return Lstm(layers, _dense(random, cells[-1], outputs))


def new_mlp(
    seed: int | tuple[int, ...], inputs: int, outputs: int, hidden: tuple[int, ...] = (16, 16), activation: str = "tanh"
) -> Mlp:
    """Hidden layers of so many units; `inputs`: rows of the window times its channels."""
    random = np.random.default_rng(seed)
    widths = (inputs, *hidden)
    layers = tuple(_dense(random, into, size) for into, size in zip(widths, hidden, strict=False))
    return Mlp(layers, _dense(random, hidden[-1], outputs), activation)
