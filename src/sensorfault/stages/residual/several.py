"""Several residual generators side by side: each sees every sample and answers for the channels it knows."""

from typing import Any, NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jaxtyping import Array, Bool

from sensorfault.core.stage import Stage, keep_finite
from sensorfault.core.types import Residual, Sample, Trust


class _Work(NamedTuple):
    before: tuple[Any, ...]
    pending: tuple[Any, ...]


class Several(eqx.Module):
    """The parts' residuals, all of them in `extra`; statistic/select_residual.py makes a statistic for one of them.

    `answers[p, c]`: part p gives channel c its residual, expected value and variance; at most one part a channel. A
    channel that no part answers for is never valid.
    """

    parts: tuple[Stage[Any, Sample, Residual, Any], ...]
    answers: Bool[Array, "P C"]

    def init(self) -> tuple[Any, ...]:
        return tuple(part.init() for part in self.parts)

    def evaluate(self, state: tuple[Any, ...], sample: Sample) -> tuple[Residual, _Work]:
        result, pending = [], []
        for part, before in zip(self.parts, state, strict=True):
            residual, work = part.evaluate(before, sample)
            valid = residual.valid & sample.fresh & jnp.isfinite(residual.value)
            result.append(residual._replace(valid=valid))
            pending.append(work)
        nothing = jnp.zeros_like(sample.value)
        value, noise, expected = nothing, nothing, sample.value
        cov = jnp.zeros((nothing.size, nothing.size))
        valid = jnp.zeros(nothing.shape, bool)
        for residual, mine in zip(result, self.answers, strict=True):
            value = jnp.where(mine, residual.value, value)
            noise = jnp.where(mine, residual.noise, noise)
            expected = jnp.where(mine, residual.expected, expected)
            cov = jnp.where(mine[:, None] & mine[None], residual.cov, cov)
            valid = jnp.where(mine, residual.valid, valid)
        together = Residual(
            time=sample.time,
            value=value,
            cov=cov,
            measured=sample.value,
            expected=expected,
            noise=noise,
            valid=valid,
            born=sample.born,
            extra=tuple(result),
        )
        return together, _Work(state, tuple(pending))

    def update(self, work: _Work, trust: Trust) -> tuple[Any, ...]:
        parts = zip(self.parts, work.pending, work.before, strict=True)
        return tuple(keep_finite(part.update(pending, trust), before) for part, pending, before in parts)
