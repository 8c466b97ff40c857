"""Shared by persistence and linear extrapolation: one test of a car's position, or one test of each joint of an arm."""

import equinox as eqx
import jax.numpy as jnp

from sensorfault.logs.rates import MISSED
from sensorfault.logs.table import Log
from sensorfault.methods.common import per_channel
from sensorfault.methods.common.watch import watchable
from sensorfault.methods.position.needs import joints_or_position
from sensorfault.methods.position.predicted import limited
from sensorfault.runtime.model import Model
from sensorfault.stages.residual.extrapolation import Extrapolation
from sensorfault.stages.threshold.fixed import Fixed


def from_last(name: str, log: Log, order: int) -> Model:
    """The model that extrapolates the last measurements.

    Raises:
        LogError: neither joints nor positions, joints that never move, too few positions, or a car that never moves.
    """
    positions = joints_or_position(name, log)
    if positions is None:
        return _of_arm(name, log, order)
    residual = Extrapolation(
        watched=jnp.asarray(positions.mark(positions.columns)),
        angle=jnp.asarray(positions.mark(positions.turning)),
        cov=jnp.eye(len(log.channels)),
        stale_s=jnp.asarray(positions.stale_s),
        order=order,
    )
    return limited(name, positions, residual, {})


def _of_arm(name: str, log: Log, order: int) -> Model:
    """Encoders count beyond a full turn, so angles are not wrapped."""
    watched, reasons = watchable(log)
    residual = Extrapolation(
        watched=jnp.asarray(watched),
        angle=jnp.zeros(len(watched), bool),
        cov=jnp.eye(len(watched)),
        stale_s=jnp.full(len(watched), (MISSED + 0.5) * log.period_s),
        order=order,
    )
    theta, spread = per_channel.healthy(log, residual)
    known = eqx.tree_at(lambda r: r.cov, residual, jnp.diag(jnp.asarray(spread**2)))
    return per_channel.model(name, log, known, Fixed(jnp.asarray(theta)), spread, {"not_watched": reasons})
