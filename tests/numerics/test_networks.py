"""Networks against plain NumPy, one window, one row and one gate after the other."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.special import expit

from laws.strict import strict
from sensorfault.numerics.networks.dense import Dense, Linear, Mlp
from sensorfault.numerics.networks.lstm import Lstm
from sensorfault.training.initial import new_lstm, new_mlp

pytestmark = pytest.mark.usefixtures("hasty")

__all__ = ["strict"]


def told_by_lstm(net: Lstm, window: np.ndarray) -> np.ndarray:
    rows = list(window)
    for layer in net.layers:
        w, u, b = (np.asarray(x) for x in (layer.inputs, layer.recurrent, layer.bias))
        cells = u.shape[1]
        h, c = np.zeros(cells), np.zeros(cells)
        result = []
        for x in rows:
            a = w @ x + u @ h + b
            i, f, g, o = (a[k * cells : (k + 1) * cells] for k in range(4))
            c = expit(f) * c + expit(i) * np.tanh(g)
            h = expit(o) * np.tanh(c)
            result.append(h)
        rows = result
    return np.asarray(net.output.weights) @ rows[-1] + np.asarray(net.output.bias)


@pytest.fixture
def windows() -> np.ndarray:
    return np.random.default_rng(1).uniform(-1, 1, (7, 12, 5))


@pytest.mark.parametrize("cells", [(4,), (6, 3), (3, 3, 2)])
def test_an_lstm_is_the_textbook_one(cells: tuple[int, ...], windows: np.ndarray) -> None:
    net = new_lstm(3, 5, 2, cells)
    want = np.array([told_by_lstm(net, window) for window in windows])
    one_by_one = np.array([net(jnp.asarray(window)) for window in windows])
    np.testing.assert_allclose(one_by_one, want, rtol=1e-12, atol=1e-14)
    together = net(jnp.asarray(windows.transpose(1, 2, 0)))
    np.testing.assert_allclose(together.T, want, rtol=1e-12, atol=1e-14)


def test_the_gradient_of_an_lstm_is_that_of_differences(windows: np.ndarray) -> None:
    net = new_lstm(5, 5, 2, (4, 3))
    target = np.array([0.3, -0.2])
    slope = jax.grad(lambda net: ((net(jnp.asarray(windows[0])) - target) ** 2).sum())(net)
    leaves, structure = jax.tree.flatten(net)
    step = 1e-6
    for k, leaf in enumerate(leaves):
        for at in np.ndindex(leaf.shape):
            costs = []
            for sign in (1, -1):
                moved = [np.array(x) for x in leaves]
                moved[k][at] += sign * step
                other = told_by_lstm(jax.tree.unflatten(structure, moved), windows[0])
                costs.append(((other - target) ** 2).sum())
            want = (costs[0] - costs[1]) / (2 * step)
            assert abs(float(jax.tree.leaves(slope)[k][at]) - want) < 1e-8, (k, at)


def test_an_mlp_is_the_textbook_one(windows: np.ndarray) -> None:
    for name, f in (("tanh", np.tanh), ("sigmoid", expit), ("relu", lambda x: np.maximum(x, 0))):
        net = new_mlp(2, 60, 2, (6, 4), name)
        want = []
        for window in windows:
            x = window.reshape(-1)
            for layer in net.hidden:
                x = f(np.asarray(layer.weights) @ x + np.asarray(layer.bias))
            want.append(np.asarray(net.output.weights) @ x + np.asarray(net.output.bias))
        np.testing.assert_allclose(net(jnp.asarray(windows.transpose(1, 2, 0))).T, want, rtol=1e-12, atol=1e-14)
        np.testing.assert_allclose(net(jnp.asarray(windows[0])), want[0], rtol=1e-12, atol=1e-14)


def test_a_linear_map_reads_the_oldest_row_first() -> None:
    net = Linear(Dense(jnp.asarray([[1.0, 10.0, 100.0, 1000.0]]), jnp.asarray([0.5])))
    assert float(net(jnp.asarray([[1.0, 2.0], [3.0, 4.0]]))[0]) == 4321.5


def test_new_networks_differ_by_their_seed_alone() -> None:
    for new in (lambda seed: new_lstm(seed, 8, 2), lambda seed: new_mlp(seed, 240, 2)):
        one, again, other = (jax.tree.leaves(new(seed)) for seed in (1, 1, 2))
        assert all((a == b).all() for a, b in zip(one, again, strict=True))
        assert any((a != b).any() for a, b in zip(one, other, strict=True))
    lstm, mlp = new_lstm(0, 8, 2), new_mlp(0, 240, 2)
    assert isinstance(lstm, Lstm)
    assert isinstance(mlp, Mlp)
    # 8-16-16-2: 64 x (8 + 16 + 1) + 64 x (16 + 16 + 1) + 2 x 17
    assert sum(leaf.size for leaf in jax.tree.leaves(lstm)) == 1600 + 2112 + 34
    assert sum(leaf.size for leaf in jax.tree.leaves(mlp)) == 16 * 241 + 16 * 17 + 2 * 17
