"""Limits for a common false alarm rate in closed loop, where every rejection changes the later innovations."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.calibration.calibrated import Calibrated, calibrated
from sensorfault.core.monitor import Monitor
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault_studies.wang2023.campaign import SETTLED, Case, false_alarms, flown

ROUNDS, CLOSE = 6, 1.08  # a rate within this factor is accepted
STEEP = -6.0  # initial slope of log rate over log limit
_FAR = 0.4  # a round changes a limit by no more than this, in logarithms


def limited(monitor: Monitor, limit: float) -> Monitor:
    """The monitor with this limit on each score of the first branch."""
    tests = jnp.ones_like(monitor.branches[0].threshold.limit)  # type: ignore[attr-defined]
    made: Monitor = eqx.tree_at(lambda m: m.branches[0].threshold, monitor, Fixed(limit * tests))
    return made


def matched(
    monitor: Monitor, of: Case, healthy: Float[np.ndarray, "N E S"], rate: float
) -> tuple[Monitor, Calibrated, float]:
    """The monitor for this false alarm rate of an epoch; its limit with an interval; the rate achieved on these runs.

    The interval is that of the open-loop limit, by resampling whole runs, scaled to the closed-loop limit.
    """
    uncalibrated = flown(limited(monitor, np.inf), of, healthy)
    open_loop = calibrated(list(uncalibrated.score[:, SETTLED:]), rate, 0)
    tried: list[tuple[float, float]] = []  # logarithms of limit and rate
    limit = open_loop.limit
    for _ in range(ROUNDS):
        reached = max(false_alarms(flown(limited(monitor, limit), of, healthy)), 1e-6)
        tried.append((float(np.log(limit)), float(np.log(reached))))
        if abs(np.log(reached / rate)) < np.log(CLOSE):
            break
        limit = float(np.exp(_next(tried, float(np.log(rate)))))
    best = min(tried, key=lambda one: abs(one[1] - np.log(rate)))
    limit, reached = float(np.exp(best[0])), float(np.exp(best[1]))
    share = limit / open_loop.limit
    return limited(monitor, limit), Calibrated(limit, open_loop.low * share, open_loop.high * share), reached


def _next(tried: list[tuple[float, float]], aim: float) -> float:
    """The next limit, by the secant through the two tried limits nearest to the aim."""
    near = sorted(tried, key=lambda one: abs(one[1] - aim))[:2]
    slope = STEEP
    if len(near) == 2 and near[0][0] != near[1][0]:
        slope = min((near[0][1] - near[1][1]) / (near[0][0] - near[1][0]), -1.0)
    at, reached = near[0]
    return at + float(np.clip((aim - reached) / slope, -_FAR, _FAR))
