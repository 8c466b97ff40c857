"""Linear Kalman filters: driven by the clock alone, or by a block of inertial rows."""

from typing import NamedTuple

import equinox as eqx
import jax.numpy as jnp
from jax import lax
from jaxtyping import Array, Bool, Float

from sensorfault.core.types import NEVER, Residual, Sample, Trust


class Belief(NamedTuple):
    mean: Float[Array, " n"]  # positions, then velocities
    cov: Float[Array, "n n"]
    time: Float[Array, ""]


class Prior(NamedTuple):
    belief: Belief
    innovation: Float[Array, " C"]


class ConstantVelocity(eqx.Module):
    """Positions and velocities under white acceleration of spectral density q; z = H x + noise of variance R."""

    h: Float[Array, "C n"]
    r: Float[Array, " C"]
    q: Float[Array, ""]
    spread: Float[Array, " n"]  # standard deviation of the first belief, around zero

    def init(self) -> Belief:
        return first_belief(self.spread)

    def evaluate(self, belief: Belief, sample: Sample) -> tuple[Residual, Prior]:
        dt = elapsed(belief, sample)
        eye, nil = jnp.eye(self.spread.size // 2), jnp.zeros((self.spread.size // 2,) * 2)
        f = jnp.block([[eye, dt * eye], [nil, eye]])
        q = self.q * jnp.block([[dt**3 / 3 * eye, dt**2 / 2 * eye], [dt**2 / 2 * eye, dt * eye]])
        return innovate(Belief(f @ belief.mean, f @ belief.cov @ f.T + q, sample.time), sample, self.h, self.r)

    def update(self, prior: Prior, trust: Trust) -> Belief:
        return correct(prior, trust, self.h, self.r)


class InertialRows(NamedTuple):
    """What an accelerometer said since the last sample; one sample carries R rows."""

    acceleration: Float[Array, " R"]
    row_ok: Bool[Array, " R"]


class Inertial(eqx.Module):
    """One position and velocity, carried along by accelerometer rows.

    A row that is not there is replaced by no acceleration at all, with the covariance that ignorance deserves.
    With `careful` False the rows are believed blindly: one NaN then spoils the prior, and the monitor must cope.
    """

    h: Float[Array, "C 2"]
    r: Float[Array, " C"]
    spread: Float[Array, " 2"]
    row_s: Float[Array, ""]  # time between rows [s]
    sigma: Float[Array, ""]  # of one good row [m/s2]
    ignorance: Float[Array, ""]  # of one missing row [m/s2]
    careful: bool = eqx.field(static=True, default=True)

    def init(self) -> Belief:
        return first_belief(self.spread)

    def evaluate(self, belief: Belief, sample: Sample) -> tuple[Residual, Prior]:
        f = jnp.eye(2) + jnp.zeros((2, 2)).at[0, 1].set(self.row_s)
        g = jnp.stack([self.row_s**2 / 2, self.row_s])

        def ahead(carry, row):
            mean, cov = carry
            acceleration, ok = row
            good = ok & jnp.isfinite(acceleration) if self.careful else jnp.ones_like(ok)
            sigma = jnp.where(good, self.sigma, self.ignorance)
            mean = f @ mean + g * jnp.where(good, acceleration, 0.0)
            return (mean, f @ cov @ f.T + jnp.outer(g, g) * sigma**2), None

        (mean, cov), _ = lax.scan(ahead, (belief.mean, belief.cov), tuple(sample.block))
        return innovate(Belief(mean, cov, sample.time), sample, self.h, self.r)

    def update(self, prior: Prior, trust: Trust) -> Belief:
        return correct(prior, trust, self.h, self.r)


def first_belief(spread: Float[Array, " n"]) -> Belief:
    return Belief(jnp.zeros_like(spread), jnp.diag(spread**2), jnp.asarray(NEVER, float))


def elapsed(belief: Belief, sample: Sample) -> Float[Array, ""]:
    return jnp.where(belief.time == NEVER, 0.0, sample.time - belief.time)


def innovate(prior: Belief, sample: Sample, h, r) -> tuple[Residual, Prior]:
    expected = h @ prior.mean
    innovation = sample.value - expected
    residual = Residual(
        time=sample.time,
        value=innovation,
        cov=h @ prior.cov @ h.T + jnp.diag(r),
        measured=sample.value,
        expected=expected,
        noise=r,
        valid=sample.fresh,
        born=sample.born,
    )
    return residual, Prior(prior, innovation)


def correct(prior: Prior, trust: Trust, h, r) -> Belief:
    """Joseph's form; a channel that is not to be taken in has no row in H."""
    mean, cov, time = prior.belief
    h = jnp.where(trust.measured[:, None], h, 0.0)
    s = h @ cov @ h.T + jnp.diag(jnp.where(trust.measured, r, 1.0))
    k = jnp.linalg.solve(s, h @ cov).T
    rest = jnp.eye(mean.size) - k @ h
    noise = jnp.diag(jnp.where(trust.measured, r, 0.0))
    innovation = jnp.where(trust.measured, prior.innovation, 0.0)
    return Belief(mean + k @ innovation, rest @ cov @ rest.T + k @ noise @ k.T, time)
