"""From tests over their limits to accused channels: what the decisions share."""

import jax.numpy as jnp

from sensorfault.core.types import Accusation, Evidence


def accuse(evidence: Evidence, share: float) -> Accusation:
    """The channels that this sample's own scores accuse.

    A test over its limit names every channel with at least `share` of its largest blame; the size of an accusation is
    blame times score over limit. Excluded channels stay accused; their size is -inf, since they are out already. Where
    a test cannot say which channel causes its alarm, all channels it covers are suspect.
    """
    named = gated = certain = suspect = tested = evidence.excluded
    unattributed = jnp.zeros_like(evidence.excluded)
    size = jnp.full(evidence.excluded.shape, -jnp.inf)
    hit = evidence.excluded.any()
    branches = zip(evidence.scores, evidence.limits, evidence.gates, evidence.certain, strict=True)
    for score, limit, gates, alone in branches:
        over = score.valid & (score.value > limit)
        most = score.blame.max(axis=1, keepdims=True)
        accused = over[:, None] & (score.blame > 0) & (score.blame >= share * most)
        times = jnp.where(limit > 0, jnp.minimum(score.value / jnp.where(limit > 0, limit, 1.0), 1e30), 1e30)
        size = jnp.maximum(size, jnp.where(accused, score.blame * times[:, None], -jnp.inf).max(axis=0))
        accused = accused.any(axis=0)
        named |= accused
        gated |= accused & gates
        certain |= accused & alone
        nobody = (over[:, None] & (most <= 0) & score.covers).any(axis=0)
        unattributed |= nobody
        suspect |= nobody | (over[:, None] & (score.blame > 0)).any(axis=0)
        tested |= (score.valid[:, None] & score.covers).any(axis=0)
        hit |= over.any()
    return Accusation(
        named, gated, certain, suspect, unattributed, jnp.where(evidence.excluded, -jnp.inf, size), tested, hit
    )
