"""Wrong recoveries and residuals, and a monitor that keeps what is not a number."""

from typing import Any

import equinox as eqx
import jax.numpy as jnp

from laws.guests.learner import Learned, Nlms, Step
from laws.mutants.judging import Stateless
from sensorfault.core.monitor import Monitor
from sensorfault.core.types import Residual, Sample, Trust
from sensorfault.core.verdicts import FAULT
from sensorfault.stages.recovery.drop import Drop


class TakesInTheAccused(Stateless):
    """A recovery that marks an accused channel measured."""

    def evaluate(self, state: tuple[()], seen: Any) -> tuple[Trust, tuple[()]]:
        trust, _ = Drop().evaluate((), seen)
        return trust._replace(measured=seen[0].fresh), ()


class LearnsWhatItTakesIn(Stateless):
    """A recovery that lets references learn from all that is measured, whatever was said of it."""

    def evaluate(self, state: tuple[()], seen: Any) -> tuple[Trust, tuple[()]]:
        trust, _ = Drop().evaluate((), seen)
        return trust._replace(learn=trust.measured), ()


class TakesHeldForNew(Stateless):
    """A recovery that marks a held value measured."""

    def evaluate(self, state: tuple[()], seen: Any) -> tuple[Trust, tuple[()]]:
        trust, _ = Drop().evaluate((), seen)
        return trust._replace(measured=seen[0].present & ~seen[3]), ()


class MotionGates(Stateless):
    """A recovery that keeps out what healthy sensors measured because the vehicle slides."""

    def evaluate(self, state: tuple[()], seen: Any) -> tuple[Trust, tuple[()]]:
        trust, _ = Drop().evaluate((), seen)
        calm = seen[2].motion != FAULT
        return trust._replace(measured=trust.measured & calm, learn=trust.learn & calm), ()


class LearnsItsWeights(eqx.Module):
    """A predictor whose weights learn from every sample, trusted or not."""

    inner: Nlms

    def init(self) -> Learned:
        return self.inner.init()

    def evaluate(self, state: Learned, sample: Sample) -> tuple[Residual, Step]:
        return self.inner.evaluate(state, sample)

    def update(self, step: Step, trust: Trust) -> Learned:
        return self.inner.update(step, trust._replace(learn=jnp.ones_like(trust.learn)))


class NeverRefills(eqx.Module):
    """A predictor whose window stays broken once it had a hole."""

    inner: Nlms

    def init(self) -> Learned:
        return self.inner.init()._replace(known=jnp.ones((self.inner.channels, 2), bool))

    def evaluate(self, state: Learned, sample: Sample) -> tuple[Residual, Step]:
        return self.inner.evaluate(state, sample)

    def update(self, step: Step, trust: Trust) -> Learned:
        after = self.inner.update(step, trust)
        return after._replace(known=after.known & step.state.known)


class KeepsAnything(Monitor):
    """A monitor for which `keep_finite` is switched off: another class, so that it is compiled anew."""
