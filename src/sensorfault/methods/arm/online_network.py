"""The method of Niu & Zhao 1998: a network predicts every sensor of an arm one sample ahead and learns online."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import jax.numpy as jnp
import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import Log, LogError
from sensorfault.methods.arm.needs import OFTEN, often
from sensorfault.methods.common import per_channel
from sensorfault.methods.common.rows import Training
from sensorfault.methods.recipe import Recipe
from sensorfault.runtime.model import Model
from sensorfault.stages.residual.online_network import OnlineNetwork
from sensorfault.stages.residual.several import Several
from sensorfault.stages.statistic.relative import Relative
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.stages.threshold.sigma import Sigma
from sensorfault.training.online import Learning, learner, noise, steps, untrained
from sensorfault.training.session import Session

NAME = "online-network"
ROUGHEST = 8.0  # times the healthy RMS; a residual above this is never explained by a motion that is hard to predict
TRAINING_SHARE = 0.7  # of the healthy log; the limits come from the rest


@dataclass(frozen=True)
class Setting:
    """How the networks are trained, and how their residuals are tested.

    `groups`: output paths of each network where there are several; no network gets the outputs of another as inputs.
    Limits are Δ + 3σ: with `slope`, as in the paper, Δ is the largest healthy change of the output from one tick to the
    next, else it comes from the tail of the healthy residual. `theta`: the whole limit of some paths [SI], whatever
    their Δ. A stand-in is used for `horizon` ticks; then the channel is unknown until it is measured again.

    With `rms_ticks` a residual is divided by its own RMS over about so many healthy ticks, but at least by its RMS on
    the healthy log: a motion that is hard to predict then raises no alarm, and an easy one hides no fault. Limits are
    in these units, so `slope` and `theta`, which are in the units of the sensor, cannot be combined with it.
    """

    learning: Learning = field(default_factory=Learning)
    groups: tuple[tuple[str, ...], ...] = ()
    slope: bool = False
    theta: Mapping[str, float] = field(default_factory=dict)
    horizon: int = per_channel.HORIZON
    rms_ticks: int = 0

    def __post_init__(self) -> None:
        if self.rms_ticks and (self.slope or self.theta):
            raise ValueError(
                "rms_ticks gives limits in units of the residual's RMS; give neither slope nor theta with it."
            )


def build(log: Log, seed: int, session: Session, setting: Setting = Setting()) -> Model:
    """Fit on a healthy log: predicts every watched channel sampled at the log's rate, from all of them and from the
    channels marked watch = false that are sampled at that rate too (torques, commands).

    Raises:
        LogError: too few complete rows, or no channel to watch.
    """
    training = often(NAME, log)
    driven, groups = _driven(log), _groups(training, setting)
    cut = log.time[0] + TRAINING_SHARE * log.duration_s
    networks = []
    for g, columns in enumerate(groups):
        session.progress(f"training network {g + 1} of {len(groups)}")
        own = replace(session, checkpoint=None)  # one file cannot hold several trainings
        networks.append(learner(log.between(end_s=cut), columns, driven, setting.learning, seed, own))
    session.progress("measuring the residuals")
    rest = log.between(cut)
    limit, spread = per_channel.healthy(rest, _side_by_side(networks, log))
    sigma = _threshold(training, limit, setting)
    threshold: Fixed | Sigma = sigma
    statistic = per_channel.SIZE
    if setting.rms_ticks:
        statistic = _relative(setting.rms_ticks, spread)
        limit, _ = per_channel.healthy(rest, _side_by_side(networks, log), statistic)
        threshold = Fixed(jnp.asarray(limit))
    networks = [replace(one, cov=jnp.diag(jnp.asarray(spread**2))) for one in networks]
    if setting.learning.scratch:
        networks = [untrained(one, np.asarray(sigma.limit()), setting.learning.warm, seed) for one in networks]
    summary = {
        "rows": int(training.rows.sum()),
        "not_watched": training.reasons,
        "inputs": [log.channels[i].path for i in driven],
    }
    return per_channel.model(
        NAME, log, _side_by_side(networks, log), threshold, spread, summary, setting.horizon, statistic
    )


def _driven(log: Log) -> tuple[int, ...]:
    """Columns of the inputs (torques, commands): marked watch = false, changing, with values in nearly every tick."""
    there = log.fresh & np.isfinite(log.value)
    return tuple(
        i
        for i, channel in enumerate(log.channels)
        if not channel.watch and there[:, i].mean() >= OFTEN and np.ptp(log.value[there[:, i], i]) > 0
    )


def _groups(training: Training, setting: Setting) -> list[tuple[int, ...]]:
    """Columns of the outputs of each network.

    Raises:
        LogError: one of the paths in `groups` cannot be predicted.
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
    """Δ + 3σ; `limit`: this sum where Δ comes from the tail of the healthy residual [SI]."""
    log, sigma = training.log, np.zeros(limit.size)
    columns = np.flatnonzero(training.watched)
    sigma[columns] = noise(log.value[:, columns])
    delta = limit - 3 * sigma
    if setting.slope:
        delta[columns] = steps(log, columns.tolist())
    for path, theta in setting.theta.items():
        delta[log.index(path)] = theta - 3 * sigma[log.index(path)]
    return Sigma(jnp.asarray(delta / log.period_s), jnp.asarray(sigma), jnp.asarray(log.period_s))


def _relative(rms_ticks: int, spread: Float[np.ndarray, " C"]) -> Relative:
    """Each residual divided by its own RMS over so many ticks."""
    lowest = jnp.asarray(spread)
    return Relative(per_channel.SIZE, jnp.asarray(float(rms_ticks)), lowest, ROUGHEST * lowest)


def _side_by_side(networks: Sequence[OnlineNetwork], log: Log) -> OnlineNetwork | Several:
    """One residual; each network gives its own outputs."""
    judged = np.array([[c in one.columns for c in range(len(log.channels))] for one in networks])
    return networks[0] if len(networks) == 1 else Several(tuple(networks), jnp.asarray(judged))


RECIPE = Recipe(
    name=NAME,
    title="Each sensor predicted one sample ahead by a network that learns online; one limit for each sensor",
    source="Niu & Zhao 1998",
    false_alarm_rate="1 false alarm an hour over all sensors, from the tail of the healthy residual",
    build=build,
    needs=often,
)
