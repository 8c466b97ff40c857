"""Paper B: a network that foretells every sensor of an arm one sample ahead, and learns while it watches."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import jax.numpy as jnp
import numpy as np

from sensorfault.logs.table import Log
from sensorfault.methods import each
from sensorfault.methods.joint import Training
from sensorfault.methods.recipe import Recipe
from sensorfault.model import Model
from sensorfault.monitor.residual.online_network import OnlineNetwork
from sensorfault.monitor.residual.several import Several
from sensorfault.training.online import Learning, learner, untaught
from sensorfault.training.session import Session

NAME = "online-network"
OFTEN = 0.9  # of the ticks: a channel that is often late breaks the rows that have to follow each other
TAUGHT = 0.7  # of the healthy log; the limits come from the rest


@dataclass(frozen=True)
class Setting:
    """How the networks are taught, and how they judge.

    `groups`: paths of the outputs of each network where there are several, each blind to what the others foretell.
    `theta`: the limits of some paths [SI]; those of the others come from the tail of the healthy residual. A stand-in
    is believed for `horizon` ticks, then the channel is unknown until it has been measured anew.
    """

    learning: Learning = field(default_factory=Learning)
    groups: tuple[tuple[str, ...], ...] = ()
    theta: Mapping[str, float] = field(default_factory=dict)
    horizon: int = each.HORIZON


def build(log: Log, seed: int, session: Session, setting: Setting = Setting()) -> Model:
    """Fit on a healthy log: every watched channel that comes with the clock is foretold from all of them, and from
    those marked watch = false that do so too (torques, commands) as the inputs.

    Raises:
        LogError: too few complete rows, or nothing to watch.
    """
    training = Training.of(NAME, log, OFTEN)
    paths = [channel.path for channel in log.channels]
    groups = setting.groups or (tuple(path for path, w in zip(paths, training.watched, strict=True) if w),)
    driven = _driven(log)
    cut = log.time[0] + TAUGHT * log.duration_s
    networks = []
    for g, group in enumerate(groups):
        session.tell(f"teaching network {g + 1} of {len(groups)}")
        columns = tuple(log.index(path) for path in group)
        networks.append(
            learner(log.between(end_s=cut), columns, driven, setting.learning, seed, replace(session, checkpoint=None))
        )
    session.tell("measuring what they leave")
    theta, sigma = each.healthy(log.between(cut), _side_by_side(networks, len(paths)))
    theta = np.array([setting.theta.get(path, limit) for path, limit in zip(paths, theta, strict=True)])
    networks = [replace(one, cov=jnp.diag(jnp.asarray(sigma**2))) for one in networks]
    if setting.learning.scratch:
        networks = [untaught(one, theta, setting.learning.warm, seed) for one in networks]
    told = {
        "rows": int(training.rows.sum()),
        "not_watched": training.reasons,
        "inputs": [paths[i] for i in driven],
    }
    return each.model(NAME, log, _side_by_side(networks, len(paths)), theta, sigma, told, setting.horizon)


def _driven(log: Log) -> tuple[int, ...]:
    """Columns of what drives the arm: not to be judged, there with nearly every tick, and moving."""
    there = log.fresh & np.isfinite(log.value)
    return tuple(
        i
        for i, channel in enumerate(log.channels)
        if not channel.watch and there[:, i].mean() >= OFTEN and np.ptp(log.value[there[:, i], i]) > 0
    )


def _side_by_side(networks: Sequence[OnlineNetwork], channels: int) -> OnlineNetwork | Several:
    """One residual, each network answering for its own outputs."""
    answers = np.array([[c in one.columns for c in range(channels)] for one in networks])
    return networks[0] if len(networks) == 1 else Several(tuple(networks), jnp.asarray(answers))


RECIPE = Recipe(
    name=NAME,
    title="Each sensor foretold one sample ahead by a network that learns while it watches, one limit a sensor",
    source="Niu & Zhao 1998",
    promise=f"{each.PER_HOUR:g} false alarm an hour in all, from the tail of the healthy residual",
    build=build,
)
