"""Do the joints of an arm move as its torques require? A Kalman filter on the arm of Niu & Zhao 1998."""

from statistics import NormalDist

import jax.numpy as jnp
import numpy as np
from jaxtyping import Bool, Float

from sensorfault.core.monitor import Branch, Monitor
from sensorfault.logs.rates import hold_s
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.arm.needs import two_joints
from sensorfault.methods.recipe import Recipe
from sensorfault.numerics.two_link import Constants
from sensorfault.runtime.model import Model, owners
from sensorfault.runtime.replay import replay_log
from sensorfault.simulation.arm import AS_PRINTED
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.drop import Drop
from sensorfault.stages.residual.arm_kalman import ArmKalman
from sensorfault.stages.statistic.whitened import Whitened
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.online import noise
from sensorfault.training.session import Session
from sensorfault.vehicles.two_link import TwoLink

FALSE_ALARMS = 1e-4  # probability for one sensor at one sample
FORGETTING = 1e-3  # process noise of one sample, as a share of the sensor's variance
GAP = 5.5  # the filter restarts after so many ticks without a measurement
WRONG_ARM = 4.0  # a larger mean square of a sensor's whitened healthy innovations shows that it is another arm


def arm_kalman(name: str, log: Log, arm: Constants = AS_PRINTED.constants, far: float = FALSE_ALARMS) -> Model:
    """Fit the sensor noise of a two-joint arm on a healthy log; `arm` is known. `far`: false alarm rate of one test.

    Raises:
        LogError: not exactly two joints, too few rows, or an arm that does not move as `arm` does.
    """
    found, watched, rows = two_joints(name, log)
    outputs, channels = (*found.rates, *found.angles), len(log.channels)
    r = noise(log.value[:, outputs]) ** 2
    limit = NormalDist().inv_cdf(1 - far / 2)
    monitor = Monitor(
        residual=ArmKalman(
            arm=TwoLink.of(arm),
            q=jnp.asarray(FORGETTING * r / log.period_s),
            r=jnp.asarray(r),
            gap_s=jnp.asarray(GAP * log.period_s),
            outputs=outputs,
            torques=found.torques,
            channels=channels,
        ),
        branches=(Branch(Whitened(tuple((c,) for c in outputs), channels), Fixed(jnp.full(len(outputs), limit))),),
        decision=Exceed(),
        recovery=Drop(),
        hold_s=jnp.asarray(hold_s(log)),
        owner=owners(log.channels, log.sensors),
    )
    sigma = _sigma(name, log, monitor, watched)
    summary = {
        "training_log": log.name,
        "training_s": log.duration_s,
        "rows": int(rows.sum()),
        "arm": arm._asdict(),
        "not_watched": {c.path: "not measured" for i, c in enumerate(log.channels) if i not in outputs},
    }
    tests = tuple(("innovation", log.channels[c].path) for c in outputs)
    return Model(name, monitor, log.channels, log.sensors, tests, tuple(watched.tolist()), log.period_s, sigma, summary)


def _sigma(name: str, log: Log, monitor: Monitor, watched: Bool[np.ndarray, " C"]) -> tuple[float, ...]:
    """Standard deviation of each channel's innovation, 1 where there is none.

    Raises:
        LogError: the log is not of this arm.
    """
    tape = replay_log(monitor, log)
    score: Float[np.ndarray, "T K"] = np.asarray(tape.scores[0])
    if not np.isfinite(score).any() or np.nanmean(score**2, axis=0).max() > WRONG_ARM:
        raise LogError(
            f"{log.name} is not of the arm of {name}, or not healthy: its innovations are far larger than the "
            "noise of its sensors; take another method."
        )
    residual = np.where(tape.valid, tape.residual, np.nan)[:, watched]
    sigma = np.ones(len(watched))
    sigma[watched] = np.sqrt(np.nanmean(residual**2, axis=0))
    return tuple(sigma.tolist())


def _build(log: Log, seed: int, session: Session) -> Model:
    return arm_kalman(RECIPE.name, log)


RECIPE = Recipe(
    name="arm-kalman",
    title="Extended Kalman filter on the two-joint arm of Niu & Zhao 1998; one innovation test for each sensor",
    source="the analytical redundancy that Niu & Zhao 1998, section 1, compare their network with",
    false_alarm_rate="one false alarm in 10,000 samples of each sensor, if the filter's model of arm and noise is "
    "right",
    build=_build,
    needs=two_joints,
)
