"""Does the position agree with the velocity, and the velocity with the inertial unit?"""

from collections.abc import Iterator
from typing import Any

import equinox as eqx
import jax.numpy as jnp
import numpy as np
from jaxtyping import Array, Bool

from sensorfault.calibration.limits import tail_limit
from sensorfault.calibration.open_loop import open_loop_scores
from sensorfault.core.monitor import Branch, Monitor
from sensorfault.logs.rates import hold_s
from sensorfault.logs.table import Log, LogError
from sensorfault.methods.position.needs import position_and_velocity
from sensorfault.methods.recipe import Recipe
from sensorfault.numerics.geodesy import SEMI_MAJOR_AXIS
from sensorfault.runtime.model import TOGETHER, Model, owners
from sensorfault.stages.decision.exceed import Exceed
from sensorfault.stages.recovery.rebuild import Rebuild
from sensorfault.stages.residual.motion_deficit import MotionDeficit
from sensorfault.stages.residual.several import Several
from sensorfault.stages.residual.velocity_deficit import VelocityDeficit
from sensorfault.stages.statistic.deficit import Deficit
from sensorfault.stages.statistic.select_residual import SelectResidual
from sensorfault.stages.statistic.shortfall import Shortfall
from sensorfault.stages.statistic.slippage import Slippage
from sensorfault.stages.statistic.stuck_position import StuckPosition
from sensorfault.stages.threshold.fixed import Fixed
from sensorfault.training.deficit import fit_deficit, fit_velocity
from sensorfault.training.mounted import inertial
from sensorfault.training.mounting import fit_mounting
from sensorfault.training.session import Session
from sensorfault.vehicles.car import Roles
from sensorfault.vehicles.inertial import Inertial

HORIZONS_S = 0.25, 1.0  # a jump, and a displacement; for a slow receiver one period of its fixes, and four
JITTER = 0.9  # two fixes may be as close as this share of a period
SHORT_S = 0.3  # shortest time of the shortfall test: three fixes at 10 Hz [s]
HALF = 2.0  # the shortfall test needs more than half of the displacement to be missing
FLOOR_M = 0.5  # a smaller missing displacement is no frozen receiver worth an alarm [m]
AFRESH_S = 30.0  # after a longer fault the comparison starts again, so that the receiver is not locked out [s]
MEMORY_S = 4.0  # time constant of the velocity integrated from the inertial unit [s]
LED_S = 8.0  # after this long without a trusted velocity the integrated one is no better than the receiver's [s]
REBUILD_S = 10.0  # a stand-in is used for at most this long [s]
READMIT_S = 2.0  # a channel is trusted again this long after its last alarm [s]
PER_HOUR = 1.0  # false alarms an hour that the limits are extrapolated to, all tests together
MARGIN = 1.25  # factor on every limit: a training drive of minutes does not show everything
SLOTS = 15  # stored references, one every 0.08 s, so at 10 Hz every fix is stored

Test = tuple[tuple[str, ...], Any, float]  # names of the tests, statistic, smallest limit


def motion_deficit(name: str, log: Log, repeats: bool = True) -> Model:
    """Fit on a healthy drive; `repeats`: also test for exactly repeated positions.

    Raises:
        LogError: no position, no velocity, a car that hardly moves, or a drive at a pole.
    """
    found = position_and_velocity(name, log)
    unit, reason = _unit(log, found)
    parts, judged, tests = _parts(log, found, unit, repeats)
    channels, count = len(log.channels), sum(len(names) for names, _, _ in tests)
    uncalibrated = Monitor(
        residual=Several(parts, jnp.stack(judged)),
        branches=tuple(
            Branch(test, Fixed(jnp.full(len(names), jnp.inf)), memory_s=_presumes_s(test)) for names, test, _ in tests
        ),
        decision=Exceed(share=1.0),
        recovery=Rebuild(jnp.asarray(REBUILD_S), jnp.asarray(READMIT_S), channels),
        hold_s=jnp.asarray(hold_s(log)),
        owner=owners(log.channels, log.sensors),
        together=False,
    )
    limits = [
        np.maximum(MARGIN * tail_limit(scores, log.period_s, PER_HOUR / count), floor)
        for (_, _, floor), scores in zip(tests, open_loop_scores(uncalibrated, log), strict=True)
    ]
    monitor = eqx.tree_at(
        lambda m: [branch.threshold.limit for branch in m.branches],
        uncalibrated,
        [jnp.asarray(limit) for limit in limits],
    )
    watched = np.asarray(jnp.stack(judged).any(axis=0))
    summary = {
        "training_log": log.name,
        "training_s": log.duration_s,
        "not_watched": {
            c.path: "not part of the comparison" for c, w in zip(log.channels, watched, strict=True) if not w
        },
    }
    if reason:
        summary["cannot"] = {"velocity against the inertial unit": reason}
    return Model(
        method=name,
        monitor=monitor,
        channels=log.channels,
        sensors=log.sensors,
        tests=tuple(test for names, statistic, _ in tests for test in _named(log, names, statistic)),
        watched=tuple(watched.tolist()),
        tick_s=log.period_s,
        sigma=tuple(_sigma(parts, found, channels).tolist()),
        summary=summary,
    )


def _unit(log: Log, found: Roles) -> tuple[Inertial | None, str]:
    """The inertial unit with its mounting, or None and the reason."""
    try:
        return inertial(fit_mounting(log, found), found), ""
    except LogError as error:
        return None, str(error)


def _parts(
    log: Log, found: Roles, unit: Inertial | None, repeats: bool
) -> tuple[tuple[Any, ...], list[Bool[Array, " C"]], list[Test]]:
    """The residual generators, the channels that each one judges, and their tests."""
    assert found.position is not None
    assert found.velocity is not None
    channels = len(log.channels)
    period_s = next(s.period_s for s in log.sensors if s.name == log.channels[found.position[0]].sensor)
    horizons_s = [max(fast, JITTER * many * period_s) for fast, many in zip(HORIZONS_S, (1, 4), strict=True)]
    deficit = MotionDeficit(
        law=jnp.ones((len(horizons_s), 4)),
        horizon_s=jnp.asarray(horizons_s),
        spacing_s=jnp.asarray(horizons_s[-1] / (SLOTS - 2)),
        afresh_s=jnp.asarray(AFRESH_S),
        inertial=unit,
        position=found.position,
        velocity=found.velocity,
        polar=found.polar,
        channels=channels,
        slots=SLOTS,
    )
    place = _mask(channels, *found.position)
    short_s = jnp.asarray(max(SHORT_S, 2 * period_s))
    tests: list[Test] = [
        (tuple(f"deficit over {horizon:g} s" for horizon in horizons_s), SelectResidual(Deficit(place), 0), 0.0),
        (("shortfall",), SelectResidual(Shortfall(short_s, jnp.asarray(HALF), place, found.position), 0), FLOOR_M),
    ]
    if repeats:
        tests.append((("stuck position",), SelectResidual(StuckPosition(place, found.position), 0), FLOOR_M))
    parts: tuple[Any, ...] = (fit_deficit(deficit, log),)
    if unit is None:
        return parts, [place], tests
    against = VelocityDeficit(
        memory_s=jnp.asarray(MEMORY_S),
        afresh_s=jnp.asarray(LED_S),
        variance=jnp.ones(2),
        inertial=unit,
        velocity=found.velocity,
        polar=found.polar,
        channels=channels,
    )
    against = fit_velocity(against, log)
    whole = _mask(channels, *found.velocity)
    speed, course = (_mask(channels, i) if found.polar else whole for i in found.velocity)
    tests.append(
        (("slip along", "slip across"), SelectResidual(Slippage(jnp.sqrt(against.variance), speed, course), 1), 0.0)
    )
    return (*parts, against), [place, whole], tests


def _named(log: Log, names: tuple[str, ...], of: SelectResidual) -> Iterator[tuple[str, str]]:
    """Each test with the paths of the channels that it accuses."""
    test = of.statistic
    masks = [test.along, test.across] if isinstance(test, Slippage) else [test.accused] * len(names)  # type: ignore[attr-defined]
    for name, mask in zip(names, masks, strict=True):
        yield name, TOGETHER.join(c.path for c, mine in zip(log.channels, np.asarray(mask), strict=True) if mine)


def _presumes_s(of: SelectResidual) -> float:
    """After a slide, a velocity unlike the inertial unit's is no sensor fault until the two are aligned again."""
    return LED_S if isinstance(of.statistic, Slippage) else 0.0


def _mask(channels: int, *columns: int) -> Bool[Array, " C"]:
    return jnp.asarray(np.isin(np.arange(channels), columns))


def _sigma(parts: tuple[Any, ...], found: Roles, channels: int) -> np.ndarray:
    """Standard deviation of each healthy residual [SI], one second after the reference, at 10 m/s."""
    assert found.position is not None
    assert found.velocity is not None
    sigma = np.ones(channels)
    metres = float(np.sqrt(np.asarray(parts[0].law)[-1] @ [1.0, 1.0, 100.0, 1.0]))
    sigma[list(found.position)] = metres / SEMI_MAJOR_AXIS
    for part in parts[1:]:
        along, across = np.sqrt(np.asarray(part.variance))
        sigma[list(found.velocity)] = (along, across / 10) if found.polar else np.hypot(along, across)
    return sigma


def _build(log: Log, seed: int, session: Session) -> Model:
    session.progress("measuring how far position and velocity differ when healthy")
    return motion_deficit(RECIPE.name, log)


RECIPE = Recipe(
    name="motion-deficit",
    title="Integrated velocity minus displacement of the position; velocity against the inertial unit",
    source="this project's own study (`sensorfault reproduce min2021`), for the jam faults of Min et al. 2021, "
    "section 2.2",
    false_alarm_rate="one false alarm an hour over all its tests, extrapolated from the tail of the training drive; "
    "each limit is 25 % higher than that",
    build=_build,
    needs=position_and_velocity,
)
