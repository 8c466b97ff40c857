"""What is done to a healthy log. Spans are slices of rows; all of it happens in the warm second half."""

import jax
import numpy as np

from laws.case import Case
from sensorfault.core.types import Sample
from sensorfault.logs.epochs import Epoch


def put(array, where, what) -> np.ndarray:
    """A copy of the array with something else in one place. In NumPy: JAX compiles anew for every slice."""
    copy = np.array(array)
    copy[where] = what
    return copy


def half(rows: Sample) -> int:
    return rows.time.shape[-1] // 2


def telling(case: Case) -> int:
    """The first row of the second half that has a new measurement on every channel."""
    fresh = np.asarray(case.rows.fresh)
    return half(case.rows) + int(np.flatnonzero(fresh[half(case.rows) :].all(axis=1))[0])


def last_telling(case: Case) -> int:
    """The last such row, and not the very last of the log."""
    return int(np.flatnonzero(np.asarray(case.rows.fresh)[:-1].all(axis=1))[-1])


def lied(rows: Sample, span: slice, offset) -> Sample:
    return rows._replace(value=put(rows.value, span, np.asarray(rows.value)[span] + offset))


def silenced(rows: Sample, span: slice, channels=slice(None)) -> Sample:
    """NaN, and marked as present: what is not a number is not there, whatever the log says."""
    return rows._replace(value=put(rows.value, (span, channels), np.nan))


def absent(rows: Sample, span: slice, channels=slice(None)) -> Sample:
    return rows._replace(
        present=put(rows.present, (span, channels), False), fresh=put(rows.fresh, (span, channels), False)
    )


def holed(rows: Sample, row: int) -> Sample:
    """One NaN in each floating array of the block. A row of an epoch is marked then, as framing marks it."""

    def hole(x):
        return put(x, (row, *[0] * (x.ndim - 1)), np.nan) if np.issubdtype(x.dtype, np.floating) else x

    block = jax.tree.map(hole, rows.block)
    if isinstance(rows.block, Epoch):
        block = block._replace(ok=put(rows.block.ok, (row, 0), False), dt=rows.block.dt)
    return rows._replace(block=block)


def alone(case: Case, channel: int) -> np.ndarray:
    """The lie of one channel."""
    return np.where(np.arange(case.channels) == channel, case.lie, 0.0)


def troubled(case: Case) -> Sample:
    """Each channel lies for a while, then is silent for a while, one after the other; at last all are silent."""
    rows, start = case.rows, half(case.rows)
    room = (rows.time.size - start - 20) // case.channels
    for c in range(case.channels):
        at = start + c * room
        rows = lied(rows, slice(at, at + room // 3), alone(case, c))
        rows = silenced(rows, slice(at + room // 2, at + room // 2 + room // 4), c)
    rows = silenced(rows, slice(-15, -10))
    return holed(rows, start + 10)
