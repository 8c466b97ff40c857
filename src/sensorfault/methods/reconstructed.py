"""A reconstruction residual made into a monitor: what the autoencoder and its baseline share."""

import equinox as eqx
import jax.numpy as jnp
import numpy as np

from sensorfault.logs.table import Log, LogError
from sensorfault.methods.watch import watchable
from sensorfault.model import Model, complete, hold_s, owners
from sensorfault.monitor.decision.exceed import Exceed
from sensorfault.monitor.monitor import Branch, Monitor
from sensorfault.monitor.recovery.rebuild import Rebuild
from sensorfault.monitor.statistic.exchange import Exchange
from sensorfault.monitor.statistic.repeats import Repeats
from sensorfault.monitor.threshold.fixed import Fixed
from sensorfault.monitor.threshold.scaled_max import ScaledMax
from sensorfault.training.cross_validation import Fit, largest_unseen_norm
from sensorfault.training.limits import repeat_limit
from sensorfault.training.scaling import Scaling
from sensorfault.training.tapes import score_tape

REBUILD_S = 10.0  # a stand-in is believed for so long
READMIT_S = 2.0  # a channel is taken at its own word again so long after the last accusation
LEAST_ROWS = 50


def reconstructed(name: str, log: Log, fit: Fit, cross_validated: bool = False) -> Model:
    """Fit on a healthy log: weights, then the limits from a replay with the limits off.

    The largest healthy error is that of the training data, as published; with `cross_validated` that of blocks left out
    of the fit, if it is larger.

    Raises:
        LogError: too few complete rows, or nothing to watch.
    """
    watched, reasons = watchable(log)
    rows = complete(log, watched)
    if rows.sum() < LEAST_ROWS:
        raise LogError(
            f"{log.name} has {rows.sum()} rows with every watched channel, {name} needs {LEAST_ROWS}; "
            "give it more data, or watch fewer channels."
        )
    value = np.where(watched, log.value, 0.0)[rows]
    scaling = Scaling.of(value, watched)
    channels = len(watched)
    hold = jnp.asarray(hold_s(log))
    residual = fit(value, scaling)
    deaf = Monitor(
        residual=residual,
        branches=(
            Branch(Exchange(jnp.asarray(scaling.half)), ScaledMax(jnp.full(1, jnp.inf))),
            Branch(Repeats(channels), Fixed(jnp.full(channels, jnp.inf)), certain=True),
        ),
        decision=Exceed(share=1.0),
        recovery=Rebuild(jnp.asarray(REBUILD_S), jnp.asarray(READMIT_S), channels),
        hold_s=hold,
        owner=owners(log.channels, log.sensors),
        most=1,
        together=False,
    )
    norm, runs = score_tape(deaf, log)
    # (10) max(err), over the training data
    largest = np.nanmax(norm, axis=0)
    if cross_validated:
        largest = np.maximum(largest, largest_unseen_norm(value, watched, fit, scaling.half))
    monitor = eqx.tree_at(
        lambda m: (m.branches[0].threshold.largest, m.branches[1].threshold.limit),
        deaf,
        (jnp.asarray(largest), jnp.asarray(repeat_limit(runs, log.period_s))),
    )
    tests = (("norm", None), *(("repeats", channel.path) for channel in log.channels))
    told = {"training_log": log.name, "training_s": log.duration_s, "rows": int(rows.sum()), "not_watched": reasons}
    sigma = tuple(np.sqrt(np.diag(np.asarray(residual.cov))).tolist())
    return Model(name, monitor, log.channels, log.sensors, tests, tuple(watched.tolist()), log.period_s, sigma, told)
