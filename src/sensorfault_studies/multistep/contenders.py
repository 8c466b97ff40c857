"""The compared observers of one flight, one for each number of steps and seed, all run at once."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import sensorfault.core._jax  # isort: skip  # noqa: F401

import jax
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool, Float

from sensorfault.core.monitor import Branch, Monitor
from sensorfault.core.types import Report, Sample
from sensorfault.core.verdicts import FAULT
from sensorfault.logs.table import Log
from sensorfault.methods.height import height_observer, kinematic_observer, multistep_observer
from sensorfault.methods.height.multistep_observer import CHI_SQUARE
from sensorfault.methods.height.needs import height_and_climb
from sensorfault.runtime.model import owners
from sensorfault.runtime.runners import replay, samples
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.recovery.rebuild import Rebuild
from sensorfault.stages.residual.height_kalman import HeightKalman
from sensorfault.stages.residual.multistep_observer import MultistepObserver
from sensorfault.stages.residual.several import Several
from sensorfault.stages.statistic.horizons import Horizons
from sensorfault.stages.statistic.select_residual import SelectResidual
from sensorfault.stages.threshold.adaptive import Adaptive
from sensorfault.training.fixes import Fixes
from sensorfault.training.height_kalman import fit_height_kalman
from sensorfault.training.multistep import Schedule, Trained, train_steps
from sensorfault.training.roll_out import errors
from sensorfault.vehicles.height import Climb, StepNetwork
from sensorfault_studies.multistep.flown import Flown

NETWORK, KINEMATIC = multistep_observer.NAME, kinematic_observer.NAME
HORIZON_S = 10.0  # in closed loop the roll-out is a stand-in for at most this long [s]


@dataclass(frozen=True)
class Seen:
    """Output of K monitors for N cells: alarms, scores (NaN where nothing was tested) and limits."""

    alarm: Bool[np.ndarray, "K N T"]
    score: Float[np.ndarray, "K N T"]
    limit: Float[np.ndarray, "K N T"]


@dataclass(frozen=True)
class Contender:
    """K observers of one kind with `steps[k]` steps, seed by seed. `variant`: name of the kind.

    `typical`: RMS of each healthy residual on the training part [m].
    """

    method: str
    variant: str
    steps: tuple[int, ...]
    seeds: int
    flown: Flown
    observers: tuple[MultistepObserver, ...]
    typical: tuple[float, ...]
    companion: HeightKalman
    trained: Trained | None = None

    def of(self, steps: int) -> list[int]:
        """Indices of the observers with so many steps, one for each seed."""
        return [k for k, n in enumerate(self.steps) if n == steps]

    def monitors(self, factor: Float[np.ndarray, " K"], closed: bool = False) -> Monitor:
        """All monitors as one, on a leading axis, with the limits factor (T_EKF + E).

        `closed`: heights with an alarm are not used in later roll-outs; else all are used, as in the paper.
        """
        made = [self._monitor(k, float(f), closed) for k, f in enumerate(factor)]
        stacked: Monitor = jax.tree.map(lambda *x: jnp.stack([jnp.asarray(one) for one in x]), *made)
        return stacked

    def _monitor(self, k: int, factor: float, closed: bool) -> Monitor:
        log = self.flown.log
        channels = len(log.channels)
        mine = np.arange(channels) == 0
        period_s = log.sensors[0].period_s
        own, start = jnp.asarray([factor]), jnp.asarray(self.typical[k : k + 1])
        threshold = Adaptive(own, own, start, jnp.asarray(CHI_SQUARE), part=1, column=0)
        return Monitor(
            residual=Several((self.observers[k], self.companion), jnp.asarray(np.stack([mine, mine & False]))),
            branches=(Branch(SelectResidual(Horizons(0), 0), threshold, gates=closed),),
            decision=Exceed(),
            recovery=Rebuild(jnp.asarray(HORIZON_S), jnp.asarray(1.5 * period_s), channels) if closed else Drop(),
            hold_s=jnp.zeros(channels),
            owner=owners(log.channels, log.sensors),
        )

    def rms(self, part: Log) -> Float[np.ndarray, " K"]:
        """RMS error of each observer's roll-outs on a healthy part of the flight [m]."""
        return np.array(
            [_rms(o.model, part, n, max(self.steps)) for o, n in zip(self.observers, self.steps, strict=True)]
        )


def _rms(model: Climb | StepNetwork, part: Log, steps: int, longest: int) -> float:
    """RMS error over `steps`; the longest is computed too, so that one compilation serves all."""
    error = errors(model, Fixes.of(part, 0, model.columns), (steps, longest))
    return float(np.sqrt(np.mean(error[0] ** 2)))


def network(flown: Flown, steps: tuple[int, ...], seeds: int, separate: bool = False) -> Contender:
    """The paper's network; inputs: vertical speed, pitch, throttle and elevator, as far as the flight has them."""
    found = flown.roles
    columns = tuple(c for c in (found.vertical, *found.inputs) if c is not None)
    fixes = Fixes.of(flown.learn, 0, columns)
    trained = train_steps(fixes, steps, range(seeds), Schedule(separate=separate))
    models = [net for nets in trained.nets for net in nets]
    words = "separate-weights" if separate else ""
    return _contender(NETWORK, words, flown, steps, seeds, models, fixes, trained)


def kinematic(flown: Flown, steps: tuple[int, ...], source: str = "receiver") -> Contender:
    """Without a network: climb rate of the receiver, as in the paper, or of the barometer."""
    climb = kinematic_observer.climbing(height_and_climb(KINEMATIC, flown.log, source)[1])
    fixes = Fixes.of(flown.learn, 0, climb.columns)
    words = "" if source == "receiver" else source
    return _contender(KINEMATIC, words, flown, steps, 1, [climb] * len(steps), fixes, None)


def _contender(
    method: str,
    variant: str,
    flown: Flown,
    steps: tuple[int, ...],
    seeds: int,
    models: Sequence[Climb | StepNetwork],
    fixes: Fixes,
    trained: Trained | None,
) -> Contender:
    every = steps * seeds
    first = height_observer.observer(models[0], fixes, (max(steps),), 0)
    made = [replace(first, model=model, steps=jnp.asarray([n])) for model, n in zip(models, every, strict=True)]
    typical = [_rms(model, flown.learn, n, max(steps)) for model, n in zip(models, every, strict=True)]
    companion = fit_height_kalman(flown.learn, 0, flown.roles)
    return Contender(method, variant, every, seeds, flown, tuple(made), tuple(typical), companion, trained)


def watch(monitors: Monitor, logs: Sequence[Log]) -> Seen:
    """Run each log from the initial state through each monitor."""
    value = np.stack([log.value for log in logs])
    cells = [samples(logs[0].time, one, np.isfinite(one)) for one in value]
    rows: Sample = jax.tree.map(lambda *x: jnp.stack(x), *cells)
    return Seen(*(np.asarray(x) for x in _watch(monitors, rows)))


@jax.jit
def _watch(monitors: Monitor, rows: Sample) -> tuple[Array, Array, Array]:
    def kept(report: Report) -> tuple[Array, Array, Array]:
        (score,), (limit,) = report.scores, report.limits
        value = jnp.where(score.valid[0], score.value[0], jnp.nan)
        return report.verdict.channel[0] == FAULT, value, limit[0]

    def one(monitor: Monitor, cell: Sample) -> tuple[Array, Array, Array]:
        return replay(monitor, monitor.init(), cell, kept)[1]

    seen: tuple[Array, Array, Array] = jax.vmap(jax.vmap(one, (None, 0)), (0, None))(monitors, rows)
    return seen
