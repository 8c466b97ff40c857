"""Fault as soon as a test exceeds its limit."""

import equinox as eqx

from sensorfault.core.types import Accusation, Evidence, Trust
from sensorfault.stages.decision.accuse import accuse


class Exceed(eqx.Module):
    """score > limit, at once. A test names the channels with at least `share` of its largest blame."""

    share: float = eqx.field(static=True, default=0.5)

    def init(self) -> tuple[()]:
        return ()

    def evaluate(self, state: tuple[()], evidence: Evidence) -> tuple[Accusation, tuple[()]]:
        return accuse(evidence, self.share), ()

    def update(self, pending: tuple[()], trust: Trust) -> tuple[()]:
        return ()
