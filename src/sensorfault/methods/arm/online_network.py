"""Paper B: a network that foretells every sensor of an arm one sample ahead, and learns while it watches."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import Log, LogError
from sensorfault.methods.common import per_channel
from sensorfault.methods.common.multivariate import Training
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model
from sensorfault.stages.residual.online_network import OnlineNetwork
from sensorfault.stages.residual.several import Several
from sensorfault.stages.statistic.relative import Relative
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.stages.threshold.sigma import Sigma
from sensorfault.training.online import Learning, learner, noise, steps, untaught
from sensorfault.training.session import Session

NAME = "online-network"
OFTEN = 0.9  # of the ticks: a channel that is often late breaks the rows that have to follow each other
ROUGHEST = 8.0  # times the healthy root mean square: worse is no motion that is hard to foretell
TAUGHT = 0.7  # of the healthy log; the limits come from the rest


@dataclass(frozen=True)
class Setting:
    """How the networks are taught, and how they judge.

    `groups`: paths of the outputs of each network where there are several, each blind to what the others foretell.
    Limits are Δ + 3σ: with `slope`, as printed, Δ is the largest step of the healthy output from one tick to the next,
    else the tail of its healthy residual decides. `theta`: the whole limit of some paths [SI], whatever their Δ. A
    stand-in is believed for `horizon` ticks, then the channel is unknown until it has been measured anew.

    With `lately` a residual is judged by its own root mean square over about so many healthy ticks, never taken for
    less than that of the healthy log, and limits are in its units: a motion that is hard to foretell is no fault, and
    an easy one hides none. Slope and theta, which are in those of the sensor, do not go with it.
    """

    learning: Learning = field(default_factory=Learning)
    groups: tuple[tuple[str, ...], ...] = ()
    slope: bool = False
    theta: Mapping[str, float] = field(default_factory=dict)
    horizon: int = per_channel.HORIZON
    lately: int = 0

    def __post_init__(self) -> None:
        if self.lately and (self.slope or self.theta):
            raise ValueError("limits in units of the lately seen residual cannot be given in those of the sensor.")


def build(log: Log, seed: int, session: Session, setting: Setting = Setting()) -> Model:
    """Fit on a healthy log: every watched channel that comes with the clock is foretold from all of them, and from
    those marked watch = false that do so too (torques, commands) as the inputs.

    Raises:
        LogError: too few complete rows, or nothing to watch.
    """
    training = Training.of(NAME, log, OFTEN)
    driven, groups = _driven(log), _groups(training, setting)
    cut = log.time[0] + TAUGHT * log.duration_s
    networks = []
    for g, columns in enumerate(groups):
        session.tell(f"teaching network {g + 1} of {len(groups)}")
        own = replace(session, checkpoint=None)  # one file cannot hold several trainings
        networks.append(learner(log.between(end_s=cut), columns, driven, setting.learning, seed, own))
    session.tell("measuring what they leave")
    rest = log.between(cut)
    limit, spread = per_channel.healthy(rest, _side_by_side(networks, log))
    sigma = _threshold(training, limit, setting)
    threshold: Fixed | Sigma = sigma
    statistic = per_channel.SIZE
    if setting.lately:
        statistic = _relative(setting.lately, spread)
        limit, _ = per_channel.healthy(rest, _side_by_side(networks, log), statistic)
        threshold = Fixed(jnp.asarray(limit))
    networks = [replace(one, cov=jnp.diag(jnp.asarray(spread**2))) for one in networks]
    if setting.learning.scratch:
        networks = [untaught(one, np.asarray(sigma.limit()), setting.learning.warm, seed) for one in networks]
    result = {
        "rows": int(training.rows.sum()),
        "not_watched": training.reasons,
        "inputs": [log.channels[i].path for i in driven],
    }
    return per_channel.model(
        NAME, log, _side_by_side(networks, log), threshold, spread, result, setting.horizon, statistic
    )


def _driven(log: Log) -> tuple[int, ...]:
    """Columns of what drives the arm: not to be judged, there with nearly every tick, and moving."""
    there = log.fresh & np.isfinite(log.value)
    return tuple(
        i
        for i, channel in enumerate(log.channels)
        if not channel.watch and there[:, i].mean() >= OFTEN and np.ptp(log.value[there[:, i], i]) > 0
    )


def _groups(training: Training, setting: Setting) -> list[tuple[int, ...]]:
    """Columns of the outputs of each network.

    Raises:
        LogError: one that cannot be foretold.
    """
    log = training.log
    if not setting.groups:
        return [tuple(np.flatnonzero(training.watched).tolist())]
    groups = [tuple(log.index(path) for path in group) for group in setting.groups]
    for path in (log.channels[c].path for group in groups for c in group):
        if path in training.reasons:
            raise LogError(f"{log.name}: {path} is {training.reasons[path]}; leave it out of the groups of {NAME}.")
    return groups


def _threshold(training: Training, limit: Float[np.ndarray, " C"], setting: Setting) -> Sigma:
    """Δ + 3σ; `limit`: what it is where Δ is the tail of the healthy residual [SI]."""
    log, sigma = training.log, np.zeros(limit.size)
    columns = np.flatnonzero(training.watched)
    sigma[columns] = noise(log.value[:, columns])
    delta = limit - 3 * sigma
    if setting.slope:
        delta[columns] = steps(log, columns.tolist())
    for path, theta in setting.theta.items():
        delta[log.index(path)] = theta - 3 * sigma[log.index(path)]
    return Sigma(jnp.asarray(delta / log.period_s), jnp.asarray(sigma), jnp.asarray(log.period_s))


def _relative(lately: int, spread: Float[np.ndarray, " C"]) -> Relative:
    """Each residual by its own root mean square over so many ticks."""
    lowest = jnp.asarray(spread)
    return Relative(per_channel.SIZE, jnp.asarray(float(lately)), lowest, ROUGHEST * lowest)


def _side_by_side(networks: Sequence[OnlineNetwork], log: Log) -> OnlineNetwork | Several:
    """One residual, each network answering for its own outputs."""
    answers = np.array([[c in one.columns for c in range(len(log.channels))] for one in networks])
    return networks[0] if len(networks) == 1 else Several(tuple(networks), jnp.asarray(answers))


RECIPE = Recipe(
    name=NAME,
    title="Each sensor foretold one sample ahead by a network that learns while it watches, one limit a sensor",
    source="Niu & Zhao 1998",
    promise=f"{per_channel.PER_HOUR:g} false alarm an hour in all, from the tail of the healthy residual",
    build=build,
    needs=lambda log: Training.of(NAME, log, OFTEN),
)
