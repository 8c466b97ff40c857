"""The protocol of every exchangeable part, and the last line of defence around each."""

from typing import Protocol, TypeVar, runtime_checkable

import jax
import jax.numpy as jnp

from sensorfault.core.types import Trust

State = TypeVar("State")
Seen = TypeVar("Seen", contravariant=True)
Result = TypeVar("Result", covariant=True)
Pending = TypeVar("Pending")


@runtime_checkable
class Stage(Protocol[State, Seen, Result, Pending]):
    """Evaluate first, then update under trust.

    `evaluate` is pure and leaves the state alone; `pending` is what it computed and `update` would compute again
    (XLA merges a repeated expression in a straight line, but not a repeated scan inside a replay).
    Memory of evidence takes every valid sample; references, thresholds and weights obey `trust.learn`.

        residual    Sample                                  -> Residual
        statistic   Residual                                -> Score
        threshold   (Residual, Score)                       -> limit (K,)
        decision    (Residual, scores, limits)              -> Accusation
        recovery    (Sample, Residual, Verdict)             -> Trust
    """

    def init(self) -> State: ...
    def evaluate(self, state: State, seen: Seen) -> tuple[Result, Pending]: ...
    def update(self, pending: Pending, trust: Trust) -> State: ...


Tree = TypeVar("Tree")


def keep_finite(new: Tree, old: Tree) -> Tree:
    """`new` if every floating number in it is finite, else `old`: a stage never walks into NaN."""
    floats = [x for x in jax.tree.leaves(new) if jnp.issubdtype(jnp.result_type(x), jnp.floating)]
    if not floats:
        return new
    good = jnp.stack([jnp.isfinite(x).all() for x in floats]).all()
    kept: Tree = jax.tree.map(lambda a, b: jnp.where(good, a, b), new, old)
    return kept
