"""The network of the extreme learning machine with all weights trained by backpropagation."""

import sensorfault.core._jax  # isort: skip  # noqa: F401

from collections.abc import Callable

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.calibration.scaling import Scaling
from sensorfault.numerics.networks.dense import Dense, Mlp
from sensorfault.stages.residual.reconstruction import Reconstruction
from sensorfault.training.gradient import Plan, Trained, train
from sensorfault.training.initial import new_mlp
from sensorfault.training.session import SILENT, Session
from sensorfault.training.windows import Windows

# Of the settings in benchmarks/bench_fit.py this one reaches the ELM's error first and the smallest error in the end.
PLAN = Plan(epochs=20_000, batch=32, rate=0.003, patience=100)

Start = Callable[[int, int, int], Mlp]


def untrained(channels: int, hidden: int, seed: int) -> Mlp:
    """Hidden weights and biases as in the ELM with the same seed, uniform in (-1, 1); small output weights."""
    random = np.random.default_rng(seed)
    w, b = random.uniform(-1, 1, (hidden, channels)), random.uniform(-1, 1, hidden)
    beta = random.normal(0, hidden**-0.5, (channels, hidden))
    output = Dense(jnp.asarray(beta), jnp.zeros(channels))
    return Mlp((Dense(jnp.asarray(w), jnp.asarray(b)),), output, "sigmoid")


def usual(channels: int, hidden: int, seed: int) -> Mlp:
    """The usual start for backpropagation: small weights (Glorot & Bengio 2010)."""
    return new_mlp(seed, channels, channels, (hidden,), "sigmoid")


def train_copy(
    x: Float[np.ndarray, "N C"], hidden: int, plan: Plan, seed: int, session: Session, start: Start = untrained
) -> Trained[Mlp]:
    """The network trained to copy scaled rows."""
    rows = Windows(x, np.arange(len(x)), x, 1)
    return train(start(x.shape[1], hidden, seed), rows, plan, seed, session)


def fit_backprop(
    value: Float[np.ndarray, "N C"],
    scaling: Scaling,
    hidden: int = 32,
    plan: Plan = PLAN,
    seed: int = 0,
    session: Session = SILENT,
    start: Start = untrained,
) -> Reconstruction:
    """Autoencoder on healthy rows (SI, finite) by backpropagation, as compared in Min et al. 2021, section 3.1.

    `start(channels, hidden, seed)`: the network before training.

    Raises:
        LogError: too few rows, or the checkpoint is of another training.
    """
    x = scaling.to_unit(value)
    network = train_copy(x, hidden, plan, seed, session, start).net
    (layer,), output = network.hidden, network.output
    w, b = np.asarray(layer.weights) * scaling.watched, np.asarray(layer.bias)
    beta, offset = np.asarray(output.weights) * scaling.watched[:, None], np.asarray(output.bias) * scaling.watched
    # (3), (4) x~ = beta f(W x + b) + offset
    copy = 1 / (1 + np.exp(-(x @ w.T + b))) @ beta.T + offset
    return scaling.reconstruction(w, b, beta, offset, "sigmoid", x - copy)
