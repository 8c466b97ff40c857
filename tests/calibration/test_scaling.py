"""Training extremes to [-1, 1]."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from sklearn.preprocessing import MinMaxScaler

from sensorfault.calibration.scaling import Scaling

VALUES = arrays(
    float,
    st.tuples(st.integers(2, 30), st.integers(1, 5)),
    elements=st.integers(-(10**9), 10**9).map(lambda thousandths: thousandths / 1000),
)


@given(VALUES)
@settings(max_examples=60, deadline=None)
def test_extremes_go_to_one(value: np.ndarray) -> None:
    moves = np.ptp(value, axis=0) > 1e-6 * np.abs(value).max(axis=0)
    x = Scaling.of(value, np.ones(value.shape[1], bool)).to_unit(value)
    want = MinMaxScaler((-1, 1)).fit_transform(value)
    np.testing.assert_allclose(x[:, moves], want[:, moves], atol=1e-8)
    np.testing.assert_allclose(np.abs(x[:, moves]).max(axis=0, initial=0), np.ones(moves.sum()), rtol=1e-8)


def test_a_constant_channel_keeps_its_unit() -> None:
    value = np.column_stack([np.full(10, 9.81), np.arange(10.0)])
    scaling = Scaling.of(value, np.ones(2, bool))
    np.testing.assert_array_equal(scaling.half, [1.0, 4.5])
    np.testing.assert_array_equal(scaling.to_unit(value)[:, 0], np.zeros(10))
    np.testing.assert_array_equal(scaling.to_unit(value + 2.0)[:, 0], np.full(10, 2.0))


def test_an_unwatched_channel_is_nothing() -> None:
    value = np.column_stack([np.arange(10.0), 1e9 * np.arange(10.0)])
    scaling = Scaling.of(value, np.array([True, False]))
    np.testing.assert_array_equal(scaling.to_unit(value)[:, 1], np.zeros(10))
    np.testing.assert_array_equal(scaling.half, [4.5, 1.0])
    np.testing.assert_array_equal(scaling.center, [4.5, 0.0])
