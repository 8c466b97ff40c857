"""Exceed at once, persist for a while, and whom an alarm accuses."""

import jax.numpy as jnp
import numpy as np

from core.scripted import Says, branch, each, says, script, walk
from sensorfault.core.verdicts import FAULT
from sensorfault.stages.decision.exceed import Exceed

NAN = np.nan


def test_share_decides_how_many_an_alarm_accuses() -> None:
    shares = Says(jnp.ones((1, 3), bool), jnp.array([[0.6, 0.3, 0.1]]))
    for share, named in ((1.0, 1), (0.5, 2), (0.1, 3)):
        monitor = says([branch(shares)], (0, 1, 2), decision=Exceed(share))
        result = walk(monitor, script([[2.0]], np.ones((1, 3))))
        assert (result.channel[0] == FAULT).sum() == named


def test_a_negative_or_no_limit_accuses_whatever_the_score() -> None:
    for limit in (0.0, -1.0, -np.inf):
        result = walk(says([branch(each(2), limit)], (0, 1), most=1), script([[0.5, -0.5]]))
        assert result.channel[0, 0] == FAULT
        assert np.isfinite(result.states.residual).all()
