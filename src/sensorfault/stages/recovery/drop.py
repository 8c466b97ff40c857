"""Leave a faulty measurement out: nothing stands in for it."""

import equinox as eqx
from jaxtyping import Array, Bool

from sensorfault.core.types import Residual, Sample, Trust, Verdict
from sensorfault.core.verdicts import OK


class Drop(eqx.Module):
    """A filter takes in what is fresh and not accused."""

    def init(self) -> tuple[()]:
        return ()

    def evaluate(
        self, state: tuple[()], seen: tuple[Sample, Residual, Verdict, Bool[Array, " C"]]
    ) -> tuple[Trust, tuple[()]]:
        sample, _, verdict, gated = seen
        measured = sample.fresh & ~gated
        learn = measured & (verdict.channel == OK) & (verdict.sample == OK)
        return Trust(sample.value, measured, gated & False, learn, sample.born), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
