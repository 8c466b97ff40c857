"""A log through a monitor, with the state after every sample: compiled once for each kind of monitor."""

from typing import NamedTuple

import equinox as eqx
import jax
import jax.numpy as jnp
import numpy as np
from jax import lax

from sensorfault.core.monitor import Monitor, MonitorState
from sensorfault.core.types import Report, Sample


class Walk(NamedTuple):
    states: MonitorState
    reports: Report

    @property
    def channel(self) -> np.ndarray:
        return self.reports.verdict.channel

    @property
    def sensor(self) -> np.ndarray:
        return self.reports.verdict.sensor

    @property
    def sample(self) -> np.ndarray:
        return self.reports.verdict.sample

    @property
    def motion(self) -> np.ndarray:
        return self.reports.verdict.motion


@eqx.filter_jit
def _walk(monitor: Monitor, state: MonitorState, rows: Sample) -> Walk:
    def one(state, sample):
        state, report = monitor.step(state, sample)
        return state, Walk(state, report)

    return lax.scan(one, state, rows)[1]


def strong(tree):
    """The same arrays without weak types."""
    return jax.tree.map(lambda x: jnp.asarray(np.asarray(x)) if isinstance(x, jax.Array) else x, tree)


def walk(monitor: Monitor, rows: Sample, state: MonitorState | None = None) -> Walk:
    """Numbers go in without weak types, which would compile the same monitor again once it was saved and loaded."""
    monitor = strong(monitor)
    walked: Walk = _walk(monitor, strong(monitor.init() if state is None else state), rows)
    return jax.tree.map(np.asarray, walked)


def finite(tree) -> bool:
    return all(np.isfinite(x).all() for x in jax.tree.leaves(tree) if np.issubdtype(x.dtype, np.floating))


def assert_close(one, two, tolerance: float = 1e-10) -> None:
    """Trees of arrays: integers and truth values exactly, floats to the tolerance."""
    assert jax.tree.structure(one) == jax.tree.structure(two)
    for a, b in zip(jax.tree.leaves(one), jax.tree.leaves(two), strict=True):
        if np.issubdtype(np.asarray(a).dtype, np.floating):
            np.testing.assert_allclose(a, b, rtol=tolerance, atol=tolerance)
        else:
            np.testing.assert_array_equal(a, b)


def assert_same(one, two) -> None:
    """To the bit."""
    assert jax.tree.structure(one) == jax.tree.structure(two)
    for a, b in zip(jax.tree.leaves(one), jax.tree.leaves(two), strict=True):
        np.testing.assert_array_equal(a, b)
