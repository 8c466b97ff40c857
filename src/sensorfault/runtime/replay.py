"""Run a monitor over a log in chunks of fixed length: compiled once for logs of any length."""

from collections.abc import Callable
from functools import partial
from typing import NamedTuple, TypeVar

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jaxtyping import Array, Bool, Float, Int8

from sensorfault.core.monitor import Monitor, MonitorState
from sensorfault.core.types import Report, Sample
from sensorfault.logs.table import Log, LogError
from sensorfault.numerics.packing import pack, unpack
from sensorfault.runtime.runners import samples

CHUNK = 8192  # rows
EPOCHS = 512  # rows a chunk of a log with a block, whose rows are long and few

Progress = Callable[[float], None]
Kept = TypeVar("Kept")
Numbers = np.ndarray | Array  # a JAX array while it runs, NumPy afterwards


class Replayed(NamedTuple):
    """What a replay keeps of each of T rows: C channels, S sensors, K tests. Scores are NaN without a test."""

    channel: Int8[Numbers, "T C"]
    sensor: Int8[Numbers, "T S"]
    sample: Int8[Numbers, " T"]
    motion: Int8[Numbers, " T"]
    scores: tuple[Float[Numbers, "T K"], ...]
    limits: tuple[Float[Numbers, "T K"], ...]
    residual: Float[Numbers, "T C"]
    valid: Bool[Numbers, "T C"]
    value: Float[Numbers, "T C"]  # measured, or its stand-in [SI]
    believed: Bool[Numbers, "T C"]  # whether `value` can be trusted
    silence: Float[Numbers, "T C"]


def _keep(report: Report) -> Replayed:
    return Replayed(
        report.verdict.channel,
        report.verdict.sensor,
        report.verdict.sample,
        report.verdict.motion,
        tuple(jnp.where(score.valid, score.value, jnp.nan) for score in report.scores),
        report.limits,
        report.residual.value,
        report.residual.valid,
        report.trust.value,
        report.trust.measured | report.trust.filled,
        report.silence,
    )


@partial(jax.jit, static_argnums=4)
def _chunk(
    monitor: Monitor, state: MonitorState, rows: Sample, real: Bool[Array, " T"], keep: Callable[[Report], Kept]
) -> tuple[MonitorState, tuple[Float[Array, "T n"], Int8[Array, "T m"]], Kept]:
    """What is kept of each row, packed, and the shapes to unpack it by, as arrays of no rows.

    Rows beyond the log's end (`real` False) leave the state alone.
    """
    shapes: list[Kept] = []

    def one(state: MonitorState, row: tuple[Sample, Array]) -> tuple[MonitorState, tuple[Array, Array]]:
        sample, real = row
        after, report = monitor.step(state, sample)
        kept: MonitorState = jax.tree.map(lambda new, old: jnp.where(real, new, old), after, state)
        shapes.append(jax.tree.map(jax.typeof, keep(report)))
        return kept, pack(keep(report))

    done: tuple[MonitorState, tuple[Array, Array]] = lax.scan(one, state, (rows, real))
    return (*done, jax.tree.map(lambda x: jnp.zeros((0, *x.shape), x.dtype), shapes[-1]))


def _strong(tree: tuple[Monitor, MonitorState]) -> tuple[Monitor, MonitorState]:
    """The same without weak types, which would make JAX compile the same step again."""
    made: tuple[Monitor, MonitorState] = jax.tree.map(lambda x: jnp.asarray(x, jnp.result_type(x)), tree)
    return made


def replay_log(monitor: Monitor, log: Log, progress: Progress | None = None) -> Replayed:
    """Judge every row of a log; the monitor starts anew. `progress` gets the share done, 0 to 1.

    Raises:
        LogError: the log is empty.
    """
    return replay_on(monitor, monitor.init(), log, progress)[1]


def replay_on(
    monitor: Monitor, state: MonitorState, log: Log, progress: Progress | None = None
) -> tuple[MonitorState, Replayed]:
    """Judge every row of a log from a given state, such as that after the previous part. Returns the state after it.

    Raises:
        LogError: the log is empty.
    """
    return replay_keeping(_keep, monitor, state, log, progress)


def replay_keeping(
    keep: Callable[[Report], Kept],
    monitor: Monitor,
    state: MonitorState,
    log: Log,
    progress: Progress | None = None,
) -> tuple[MonitorState, Kept]:
    """As `replay_on`, with a choice of what is kept of each row.

    `keep`: a function of a module, whose values are floats, truth values and integers from -128 to 127.

    Raises:
        LogError: the log is empty.
    """
    total = len(log)
    if not total:
        raise LogError(f"{log.name} has no rows to replay; give a longer part of it.")
    (monitor, state), result = _strong((monitor, state)), []
    long = EPOCHS if log.block else CHUNK
    for start in range(0, total, long):
        rows = np.minimum(np.arange(start, start + long), total - 1)
        real = np.arange(start, start + long) < total
        block = jax.tree.map(lambda array, rows=rows: array[rows], log.block)
        chunk = samples(log.time[rows], log.value[rows], log.fresh[rows], block)
        state, kept, none = _chunk(monitor, state, chunk, jnp.asarray(real), keep)
        result.append([np.asarray(part) for part in kept])
        if progress:
            progress(min(1.0, (start + long) / total))
    example: Kept = jax.tree.map(lambda x: np.empty(x.shape[1:], x.dtype), none)
    return state, unpack(example, *(np.concatenate(parts)[:total] for parts in zip(*result, strict=True)))
