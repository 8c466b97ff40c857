"""Online network residual: new measurements minus the prediction of a network that learns while it runs."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import NEVER, Residual, Sample, Trust
from sensorfault.numerics.columns import picked
from sensorfault.numerics.networks.dense import Mlp
from sensorfault.numerics.networks.online import taught

MOST = 2.0  # of what the network sees


class _State(NamedTuple):
    network: Mlp
    outputs: Float[Array, "m D"]  # y(k) .. y(k-m+1), as far as they were trusted or stood in for [SI]
    inputs: Float[Array, "n U"]  # u(k) .. u(k-n+1) [SI]
    known: Float[Array, " D"]  # rows of the window since the output came (again), m at most
    received: Float[Array, ""]  # rows since all inputs came (again), n + 1 at most
    clean: Float[Array, ""]  # rows since all outputs were taken at their word (again), m at most
    quiet: Float[Array, ""]  # learned samples in a row that were predicted well, `warm` at most
    time: Float[Array, ""]  # of y(k) [s]


class _Work(NamedTuple):
    state: _State
    x: Float[Array, " N"]
    inputs: Float[Array, "p U"]  # p = n + 1
    expected: Float[Array, " D"]
    now: Float[Array, ""]


class OnlineNetwork(eqx.Module):
    """y~(k+1) = F(y(k) .. y(k-m+1), u(k+1) .. u(k-n+1)), learned one sample at a time. Niu & Zhao 1998, equation (1).

    F is an Mlp of one hidden layer; it predicts y(k+1) - y(k) in units of `step`, or with `absolute` y(k+1) itself.
    It sees y(k) and u on [-1, 1], and what lies before y(k) as increments: two rows are
    nearly the same, so the network sees their difference only as an input of its own.

    An output is valid where its own window and the inputs are whole, without a gap in the clock of more than `gap_s`.
    It is learned where the monitor allows it, from windows that were measured throughout. Before `warm` samples in a
    row have been predicted within `settled` nothing is valid, and what is measured is learned unjudged.
    """

    network: Mlp  # to begin with
    center: Float[Array, " Y"]  # Y = D + U: of the outputs, then of the inputs [SI]
    half: Float[Array, " Y"]  # half of their range [SI]
    step: Float[Array, " D"]  # the largest increment [SI]
    cov: Float[Array, "C C"]  # of the residual on healthy data [SI]
    tolerance: Float[Array, " D"]  # an error too small to learn from [SI]
    settled: Float[Array, " D"]  # [SI]
    rate: Float[Array, ""]
    warm: Float[Array, ""]
    gap_s: Float[Array, ""]
    columns: tuple[int, ...] = eqx.field(static=True)  # of the outputs
    driven: tuple[int, ...] = eqx.field(static=True)  # columns of the inputs
    delays: tuple[int, int] = eqx.field(static=True)  # m, n
    iterations: int = eqx.field(static=True)  # for one sample, at most
    absolute: bool = eqx.field(static=True, default=False)

    def init(self) -> _State:
        d = len(self.columns)
        m, n = self.delays
        nothing = jnp.zeros(())
        return _State(
            network=self.network,
            outputs=jnp.tile(self.center[:d], (m, 1)),
            inputs=jnp.tile(self.center[d:], (n, 1)),
            known=jnp.zeros(d),
            received=nothing,
            clean=nothing,
            quiet=nothing,
            time=jnp.asarray(NEVER, float),
        )

    def evaluate(self, state: _State, sample: Sample) -> tuple[Residual, _Work]:
        m, n = self.delays
        away = sample.time - state.time
        gone = (away > self.gap_s) | (away <= 0)
        anew = gone | picked(sample.born, self.columns)
        there = picked(sample.present, self.driven).all()
        state = state._replace(
            known=jnp.where(anew, 0.0, state.known),
            received=jnp.where(there, jnp.minimum(jnp.where(gone, 0.0, state.received), n) + 1, 0.0),
            clean=jnp.where(anew.any(), 0.0, state.clean),
        )
        inputs = jnp.concatenate([picked(sample.value, self.driven)[None], state.inputs])
        x = self._seen(state.outputs, inputs)
        # (1) y~(k+1) = F(y(k) .. y(k-m+1), u(k+1) .. u(k-n+1))
        origin, unit = self._origin(state)
        expected = origin + unit * state.network(x[None])
        ready = (state.known >= m) & (state.received > n) & (state.quiet >= self.warm)
        nothing = jnp.zeros_like(sample.value)
        residual = Residual(
            time=sample.time,
            value=self._placed(picked(sample.value, self.columns) - expected, nothing),
            cov=self.cov,
            measured=sample.value,
            expected=self._placed(expected, sample.value),
            noise=(jnp.eye(nothing.size) * self.cov).sum(axis=1),
            valid=sample.fresh & self._placed(ready, nothing > 0),
            born=sample.born,
        )
        return residual, _Work(state, x, inputs, expected, sample.time)

    def update(self, pending: _Work, trust: Trust) -> _State:
        state, x, inputs, expected, now = pending
        m, n = self.delays
        measured, filled = picked(trust.measured, self.columns), picked(trust.filled, self.columns)
        d = len(self.columns)
        # A missing output is still an input of the others: its prediction stands in, within its range.
        predicted = jnp.clip(expected, self.center[:d] - self.half[:d], self.center[:d] + self.half[:d])
        y = jnp.where(measured | filled, picked(trust.value, self.columns), predicted)
        target, teaches = self.lesson(pending, trust)
        _, unit = self._origin(state)
        network = taught(state.network, x, target, teaches, self.tolerance / unit, self.rate, self.iterations)
        well = (~teaches | (jnp.abs(y - expected) <= self.settled)).all()
        quiet = jnp.where(well, jnp.minimum(state.quiet + 1, self.warm), 0.0)
        return _State(
            network=network,
            outputs=jnp.concatenate([y[None], state.outputs[:-1]]),
            inputs=inputs[:n],
            known=jnp.where(measured | filled, jnp.minimum(state.known + 1, m), 0.0),
            received=state.received,
            clean=jnp.where(measured.all(), jnp.minimum(state.clean + 1, m), 0.0),
            quiet=jnp.where((state.quiet < self.warm) & teaches.any(), quiet, state.quiet),
            time=now,
        )

    def lesson(self, pending: _Work, trust: Trust) -> tuple[Float[Array, " D"], Bool[Array, " D"]]:
        """What the network should have answered to `pending.x`, and the outputs it may learn."""
        state = pending.state
        m, n = self.delays
        origin, unit = self._origin(state)
        unjudged = state.quiet < self.warm
        allowed = picked(trust.learn, self.columns) | (unjudged & picked(trust.measured, self.columns))
        whole = (state.clean >= m) & (state.received > n)
        return (picked(trust.value, self.columns) - origin) / unit, allowed & whole

    def _seen(self, outputs: Float[Array, "m D"], inputs: Float[Array, "p U"]) -> Float[Array, " N"]:
        """What the network sees: the newest outputs, the increments before them, the inputs.

        All lie within 1 in health; what is farther out than MOST says no more than MOST would.
        """
        d = len(self.columns)
        y = (outputs[0] - self.center[:d]) / self.half[:d]
        before = (outputs[:-1] - outputs[1:]) / self.step[None]
        u = (inputs - self.center[None, d:]) / self.half[None, d:]
        return jnp.clip(jnp.concatenate([y, before.ravel(), u.ravel()]), -MOST, MOST)

    def _origin(self, state: _State) -> tuple[Float[Array, " D"], Float[Array, " D"]]:
        """What the network's answer counts from, and in which unit [SI]."""
        d = len(self.columns)
        return (self.center[:d], self.half[:d]) if self.absolute else (state.outputs[0], self.step)

    def _placed(self, of_outputs: Array, of_others: Array) -> Array:
        """One number a channel: those of the outputs in their places."""
        return jnp.stack(
            [of_outputs[self.columns.index(c)] if c in self.columns else of_others[c] for c in range(of_others.size)]
        )
