"""Run a monitor's step: over a log (scan), live (one compiled step), or over many vehicles at once (vmap)."""

from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax
import jax.numpy as jnp
import numpy as np
from jax import lax
from jax.flatten_util import ravel_pytree
from jaxtyping import Array, Bool, Float, Int8

from sensorfault.core.monitor import Monitor, MonitorState
from sensorfault.core.types import Report, Sample
from sensorfault.core.verdicts import UNKNOWN

Kept = TypeVar("Kept")


def everything(report: Report) -> Report:
    """Keep the full report: 3 kB a row for 12 channels."""
    return report


def samples(
    time: Float[np.ndarray, " T"], value: Float[np.ndarray, "T C"], fresh: Bool[np.ndarray, "T C"], block: Any = ()
) -> Sample:
    """Rows of a log as samples for a monitor; NaN means absent."""
    present = np.isfinite(value)
    return Sample(
        jnp.asarray(time),
        jnp.asarray(value),
        jnp.asarray(present),
        jnp.asarray(fresh & present),
        jnp.zeros(value.shape, bool),
        jax.tree.map(jnp.asarray, block),
    )


def replay(
    monitor: Monitor,
    state: MonitorState,
    rows: Sample,
    keep: Callable[[Report], Kept] = everything,  # type: ignore[assignment]
) -> tuple[MonitorState, Kept]:
    """Run the monitor over all rows. Returns the state after them, and what `keep` keeps of each, stacked over time."""

    def one(state: MonitorState, sample: Sample) -> tuple[MonitorState, Kept]:
        state, report = monitor.step(state, sample)
        return state, keep(report)

    return lax.scan(one, state, rows)


def fleet(
    monitor: Monitor,
    states: MonitorState,
    rows: Sample,
    keep: Callable[[Report], Kept] = everything,  # type: ignore[assignment]
) -> tuple[MonitorState, Kept]:
    """Run one monitor over many vehicles, or many injected faults: `states` and `rows` have a leading axis.

    It runs on the device that holds the arguments. `jax.device_put` moves them to a GPU, which pays off for a thousand
    vehicles or more.
    """
    return jax.vmap(lambda state, one: replay(monitor, state, one, keep))(states, rows)


class StepResult(NamedTuple):
    """The verdicts, tests and values of one live sample."""

    channel: Int8[np.ndarray, " C"]
    sensor: Int8[np.ndarray, " S"]
    sample: int
    motion: int  # of the vehicle
    score: Float[np.ndarray, " K"]  # of all branches, one after the other; NaN where there was nothing to test
    limit: Float[np.ndarray, " K"]
    value: Float[np.ndarray, " C"]  # measured, or its stand-in [SI]
    residual: Float[np.ndarray, " C"]  # [SI]
    valid: Bool[np.ndarray, " C"]  # whether the residual was tested
    silence: Float[np.ndarray, " C"]  # [s]


def nothing_yet(monitor: Monitor) -> StepResult:
    """The result before the first sample."""
    channels, sensors = len(monitor.owner), max(monitor.owner) + 1
    unknown = np.full(channels, UNKNOWN, np.int8), np.full(sensors, UNKNOWN, np.int8)
    nan, none = np.full(channels, np.nan), np.full(0, np.nan)
    return StepResult(*unknown, UNKNOWN, UNKNOWN, none, none, nan, nan, np.zeros(channels, bool), np.zeros(channels))


def _tell(report: Report) -> tuple[Array, ...]:
    return (
        report.verdict.channel,
        report.verdict.sensor,
        report.verdict.sample,
        report.verdict.motion,
        jnp.concatenate([jnp.where(score.valid, score.value, jnp.nan) for score in report.scores]),
        jnp.concatenate(report.limits),
        report.trust.value,
        report.residual.value,
        report.residual.valid,
        report.silence,
    )


class Stepper:
    """One sample in, one verdict out.

    Two things make a live step fast. State, sample and result are one vector each, so that few arguments are passed to
    the compiled step. And the step is the body of a loop of one round. The number of rounds is part of the sample, so
    the compiler does not know it and compiles the whole step as one function (see core/_jax.py).

    `block`: an example of the residual's private block, for monitors that have one.
    """

    def __init__(self, monitor: Monitor, block: Any = ()) -> None:
        self._made_of = monitor, block
        channels = len(monitor.owner)
        self._state, restore = ravel_pytree(monitor.init())
        extra, restore_block = ravel_pytree(block)
        self._channels = channels
        self._row = np.ones(2 + 3 * channels + extra.size)  # [rounds, time, value, fresh, born, block]
        one_round = np.eye(1, self._row.size)[0]

        def unpack(row: Array) -> Sample:
            value, fresh, born = row[2 : 2 + 3 * channels].reshape(3, channels)
            there = jnp.ones(channels, bool)
            return Sample(row[1], value, there, fresh > 0, born > 0, restore_block(row[2 + 3 * channels :]))

        def once(flat: Array, row: Array) -> tuple[Array, Array]:
            state, report = monitor.step(restore(flat), unpack(row))
            return ravel_pytree(state)[0], ravel_pytree(_tell(report))[0]

        def step(flat: Array, row: Array) -> tuple[Array, Array]:
            answer = jnp.zeros(jax.eval_shape(once, flat, row)[1].shape)
            flat, answer, _ = lax.while_loop(
                lambda carry: carry[2][0] > 0,
                lambda carry: (*once(carry[0], carry[2]), carry[2] - one_round),
                (flat, answer, row),
            )
            return flat, answer

        self._step = jax.jit(step, donate_argnums=0)
        self._state, _ = self._step(self._state, np.zeros_like(self._row))  # compile; with no round, the state stays
        result = jax.eval_shape(
            lambda flat, row: _tell(monitor.step(restore(flat), unpack(row))[1]), self._state, self._row
        )
        ends = np.cumsum([int(np.prod(one.shape)) for one in result]).tolist()
        self._cuts = [slice(a, b) for a, b in zip([0, *ends[:-1]], ends, strict=True)]

    def __reduce__(self) -> Any:
        return _stepper, (*self._made_of, np.asarray(self._state))

    def push(self, time: float, value: Any, fresh: Any = True, block: Any = (), born: Any = False) -> StepResult:
        """Judge one sample.

        Args:
            time: [s].
            value: (C,) in SI units, NaN if absent.
            fresh: (C,) or one for all, which values are new measurements.
            block: as the example.
            born: (C,) or one for all, which channels have just appeared.

        Raises:
            ValueError: not as many values as channels, or a block of another size than the example.
        """
        row, c = self._row, self._channels
        if not hasattr(value, "__len__") or len(value) != c:
            raise ValueError(f"push: {value!r} for {c} channels; give one value each, NaN for what is absent.")
        row[1] = time
        row[2 : 2 + c] = value
        row[2 + c : 2 + 2 * c] = fresh
        row[2 + 2 * c : 2 + 3 * c] = born
        tail, parts = row[2 + 3 * c :], [np.ravel(x) for x in jax.tree.leaves(block)]
        if (size := sum(part.size for part in parts)) != tail.size:
            raise ValueError(
                f"push: the block has {size} numbers, the example had {tail.size}; give a block of the same size."
            )
        if parts:
            tail[:] = np.concatenate(parts)
        self._state, result = self._step(self._state, row)
        answer = np.asarray(result)
        channel, sensor, sample, motion, score, limit, value, residual, valid, silence = (
            answer[cut] for cut in self._cuts
        )
        verdicts = channel.astype(np.int8), sensor.astype(np.int8), int(sample[0]), int(motion[0])
        return StepResult(*verdicts, score, limit, value, residual, valid > 0, silence)


def _stepper(monitor: Monitor, block: Any, state: Float[np.ndarray, " n"]) -> Stepper:
    """The stepper that was pickled: compiled anew, in the state it was in."""
    stepper = Stepper(monitor, block)
    stepper._state = jnp.asarray(state)
    return stepper
