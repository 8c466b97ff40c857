"""Prediction residual: a new measurement minus a network's prediction from the window of samples before it."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import NEVER, Residual, Sample, Trust
from sensorfault.numerics.local import wrapped
from sensorfault.numerics.networks.dense import Linear, Mlp
from sensorfault.numerics.networks.lstm import Lstm


class _State(NamedTuple):
    window: Float[Array, "s V"]  # the samples before, scaled, the oldest first
    rows: Float[Array, " D"]  # rows of the window since the output came (again)
    taken: Float[Array, " D"]  # when the output last came or was stood in for [s]
    time: Float[Array, ""]  # of the newest row [s]


class _Work(NamedTuple):
    state: _State
    now: Float[Array, ""]


class Prediction(eqx.Module):
    """y~(i) = net(V(i-s), .., V(i-1)), inputs mapped to [-1, 1] by their training extremes. Min et al. 2021, 2.2.

    `inputs` are the columns of V; the first D of them are predicted. The window holds what was trusted: the
    measurement, the stand-in for it, or, where there was neither, what it held before. Of an input that is an `angle`
    only the difference to `center` within half a turn counts, so that the date line is a place like any other.

    An output is valid once the window is full of rows since it came. A gap in the clock of more than `gap_s`, or more
    than `stale_s` without a value to take, and its window starts anew.
    """

    network: Lstm | Mlp | Linear
    center: Float[Array, " V"]  # middle of the training range [SI]
    half: Float[Array, " V"]  # half of the training range [SI]
    angle: Bool[Array, " V"]
    cov: Float[Array, "C C"]  # of the residual on healthy data [SI]
    gap_s: Float[Array, ""]
    stale_s: Float[Array, " D"]
    length: int = eqx.field(static=True)  # s
    inputs: tuple[int, ...] = eqx.field(static=True)

    def init(self) -> _State:
        outputs = self.stale_s.size
        never = jnp.full((), NEVER, float)
        return _State(
            jnp.zeros((self.length, len(self.inputs))), jnp.zeros(outputs), jnp.full(outputs, NEVER, float), never
        )

    def evaluate(self, state: _State, sample: Sample) -> tuple[Residual, _Work]:
        d = self.stale_s.size
        gone = (sample.time - state.time > self.gap_s) | (sample.time - state.taken > self.stale_s)
        state = state._replace(rows=jnp.where(gone, 0.0, state.rows))
        # V~(i) from V(i-s) .. V(i-1)
        y = self.network(state.window)
        expected = self.center[:d] + y * self.half[:d]
        expected = jnp.where(self.angle[:d], wrapped(expected), expected)
        value = self._away(self._inputs(sample.value)[:d], expected)
        warm = state.rows >= self.length
        nothing = jnp.zeros_like(sample.value)
        residual = Residual(
            time=sample.time,
            value=self._placed(value, nothing),
            cov=self.cov,
            measured=sample.value,
            expected=self._placed(expected, sample.value),
            noise=(jnp.eye(nothing.size) * self.cov).sum(axis=1),
            valid=sample.fresh & self._placed(warm, nothing > 0),
            born=sample.born,
        )
        return residual, _Work(state, sample.time)

    def update(self, pending: _Work, trust: Trust) -> _State:
        state, now = pending
        d = state.rows.size
        taken = self._inputs(trust.measured | trust.filled)
        x = self._away(self._inputs(trust.value), self.center) / self.half
        row = jnp.where(taken, x, state.window[-1])
        came = jnp.where(taken[:d], now, state.taken)
        rows = jnp.where(now - came > self.stale_s, 0.0, jnp.minimum(state.rows + 1, self.length))
        return _State(jnp.concatenate([state.window[1:], row[None]]), rows, came, now)

    def _inputs(self, each: Array) -> Array:
        """The inputs out of one number a channel."""
        return jnp.stack([each[i] for i in self.inputs])

    def _placed(self, of_outputs: Array, of_others: Array) -> Array:
        """One number a channel: those of the outputs in their places."""
        outputs = self.inputs[: self.stale_s.size]
        return jnp.stack(
            [of_outputs[outputs.index(c)] if c in outputs else of_others[c] for c in range(of_others.size)]
        )

    def _away(self, value: Float[Array, " n"], origin: Float[Array, " n"]) -> Float[Array, " n"]:
        """value - origin, the short way round for angles."""
        return jnp.where(self.angle[: value.size], wrapped(value - origin), value - origin)
