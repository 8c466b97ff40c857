"""All that must obey the laws: the toy guests, and the catalog.

A recipe that judges whole samples of the inertial unit is under the laws by being in the catalog. Any other needs a
Case in ALONE: a monitor fitted on one log, and a few hundred samples of another one.
"""

import functools
from dataclasses import replace

import equinox as eqx
import numpy as np

import flown
from laws.case import Case, limits_learned
from laws.guests.zoo import zoo
from laws.rides import navigating
from sensorfault.core.monitor import Monitor
from sensorfault.logs.table import Channel, Log, Sensor
from sensorfault.methods.arm import online_network
from sensorfault.methods.arm.online_network import NAME as NETWORK
from sensorfault.methods.arm.online_network import Setting
from sensorfault.methods.catalog import METHODS
from sensorfault.methods.height import cusum, kinematic_observer, mean_pair, multistep_observer, ramp_glr, slope
from sensorfault.methods.height.drifting import drift
from sensorfault.methods.inertial import bp_autoencoder
from sensorfault.methods.position import ar_predictor, lstm_displacement, lstm_predictor, mlp_predictor
from sensorfault.methods.position.predicted import READMIT_S, REBUILD_S
from sensorfault.runtime.runners import samples
from sensorfault.simulation.acoustic import Ranging
from sensorfault.simulation.arm import PERIOD_S, run
from sensorfault.simulation.flapping_wing import fly
from sensorfault.simulation.road import drive
from sensorfault.simulation.underwater import sail
from sensorfault.stages.residual.conditioning import Conditioning
from sensorfault.stages.residual.reconstruction import Reconstruction
from sensorfault.stages.statistic.exchange import Exchange
from sensorfault.training.gradient import Plan
from sensorfault.training.multistep import Schedule
from sensorfault.training.online import Learning
from sensorfault.training.session import Session

POSITION = ["gnss.latitude", "gnss.longitude"]
UNDER_WAY = 262.0, 282.0  # [s] of the drive: at 7 to 13 m/s
IMU = [f"{sensor}.{axis}" for sensor in ("gyro", "accelerometer") for axis in "xyz"]


def joint(name: str) -> Case:
    """A recipe that judges whole samples of the inertial unit, fitted on four minutes of a simulated drive, before
    eight seconds of the fifth.
    """
    log = drive(300.0, seed=3).log.select(IMU)
    unseen = log.between(280.0, 288.0)
    rows = samples(unseen.time, unseen.value, unseen.fresh)
    lie = 40 * log.value.std(axis=0)
    monitor = SMALL.get(name, METHODS[name].build)(log.between(end_s=240.0), 0, Session()).monitor
    back_s = float(monitor.recovery.readmit_s) + log.period_s * getattr(monitor.residual, "lags", 0)
    return Case(name, monitor, rows, lie, back_s, permuted=functools.partial(_permuted, monitor))


DRIFTS = {test.name: test for test in (slope.TEST, mean_pair.TEST, ramp_glr.TEST, cusum.TEST)}
BACK_S = 3.0  # the bicycle's filter begins anew
PLAN = Plan(epochs=3, batch=256)
SMALL = {"bp-autoencoder": functools.partial(bp_autoencoder.build, plan=Plan(epochs=100, batch=256, rate=0.01))}
PREDICTORS = {
    "lstm-predictor": functools.partial(lstm_predictor.build, size=lstm_predictor.Size(10, (4, 4), PLAN)),
    "lstm-displacement": functools.partial(lstm_displacement.build, size=lstm_displacement.Size((4, 4), PLAN)),
    "mlp-predictor": functools.partial(mlp_predictor.build, size=mlp_predictor.Size(10, (8,), PLAN)),
    "ar-predictor": functools.partial(ar_predictor.build, length=10),
    "persistence": METHODS["persistence"].build,
    "linear-extrapolation": METHODS["linear-extrapolation"].build,
}


def predictor(name: str) -> Case:
    """A predictor of the position, small and hardly trained, on a part of its own drive, since a network knows no place
    that it has never seen.
    """
    log = drive(120.0, seed=3).log.select([*IMU, *POSITION])
    part = log.between(78.0, 94.0)
    rows = samples(part.time, part.value, part.fresh)
    lie = np.where(np.arange(8) >= 6, 40 * log.value.std(axis=0), 0.0)
    back_s = REBUILD_S + READMIT_S + 2.5
    lost = {6: (7,), 7: (6,)} if name == "lstm-displacement" else {}  # half a position is none
    return Case(name, PREDICTORS[name](log, 0, Session()).monitor, rows, lie, back_s, named=(6, 7), lost=lost)


def deficit() -> Case:
    """The motion deficit, fitted on four minutes, in a part of the fifth in which the car is under way.

    Without one of its two numbers a position is none, nor is a velocity; without the inertial unit nothing is known of
    the velocity.
    """
    log = drive(300.0, seed=3).log.select([*IMU, *POSITION, "gnss.speed", "gnss.course"])
    monitor = METHODS["motion-deficit"].build(log.between(end_s=240.0), 0, Session()).monitor
    part = log.between(*UNDER_WAY)
    lie = np.concatenate([np.zeros(6), np.deg2rad([0.01, 0.01]), [40.0], [2.0]])
    lost = dict.fromkeys(range(6), (8, 9)) | {6: (7,), 7: (6,), 8: (9,), 9: (8,)}
    back_s = float(monitor.recovery.readmit_s) + 3.0
    rows = samples(part.time, part.value, part.fresh)
    return Case("motion-deficit", monitor, rows, lie, back_s, named=(6, 7, 8, 9), lost=lost)


def whole_car() -> Case:
    """All of it together: who answers for a channel is the part that knows it best."""
    alone = deficit()
    log = drive(300.0, seed=3).log.select([*IMU, *POSITION, "gnss.speed", "gnss.course"])
    monitor = METHODS["car"].build(log.between(end_s=240.0), 0, Session()).monitor
    lie = np.concatenate([40 * log.value[:, :6].std(axis=0), alone.lie[6:]])
    return replace(alone, name="car", monitor=monitor, lie=lie, named=None)


def of_motion(name: str) -> Case:
    """A recipe that accuses the motion and no channel, where the car is under way."""
    log = drive(300.0, seed=3).log.select([*IMU, *POSITION, "gnss.speed", "gnss.course"])
    monitor = METHODS[name].build(log.between(120.0, 240.0), 0, Session()).monitor
    part = log.between(*UNDER_WAY)
    lie = np.concatenate([np.zeros(6), np.deg2rad([0.01, 0.01]), [40.0], [2.0]])
    return Case(name, monitor, samples(part.time, part.value, part.fresh), lie, BACK_S, named=())


def two_links() -> Case:
    """The filter of a two-joint arm."""
    monitor = METHODS["arm-kalman"].build(run(seed=1), 0, Session()).monitor
    log = run(seed=2, samples=400)
    lie = np.array([0.5, 0.5, 0.5, 0.5, 0.0, 0.0])
    rows = samples(log.time, log.value, log.fresh)
    return Case("arm-kalman", monitor, rows, lie, 5 * PERIOD_S, named=(0, 1, 2, 3))


def arm() -> Case:
    """Two joints, each a driven oscillator, that the network knows from 40 s, in the 8 s after them.

    Without the torques nothing can be foretold.
    """
    log = two_joints(2400)
    setting = Setting(learning=Learning(plan=Plan(epochs=20, rate=1e-2)))
    monitor = online_network.build(log.between(end_s=40.0), 0, Session(), setting).monitor
    part = log.between(40.0)
    lie = np.concatenate([0.1 * np.ptp(log.value[:, :4], axis=0), np.zeros(2)])
    outputs = (0, 1, 2, 3)
    return Case(
        NETWORK,
        monitor,
        samples(part.time, part.value, part.fresh),
        lie,
        back_s=float(monitor.recovery.horizon_s) + 0.1,
        learned=lambda state: (state.residual.network, limits_learned(state)),
        named=outputs,
        lost={4: outputs, 5: outputs},
    )


def two_joints(rows: int) -> Log:
    """Rates and angles of two joints at 50 Hz, and the torques that drive them."""
    random, dt = np.random.default_rng(8), 0.02
    torque = np.stack([np.sin(np.arange(rows) * dt * w) for w in (1.3, 2.1)], axis=1)
    rate, angle = np.zeros((rows, 2)), np.zeros((rows, 2))
    for k in range(1, rows):
        pull = torque[k] - 4 * np.sin(angle[k - 1]) - 0.5 * rate[k - 1] + 0.3 * rate[k - 1, ::-1]
        rate[k], angle[k] = rate[k - 1] + dt * pull, angle[k - 1] + dt * rate[k - 1]
    value = np.hstack([rate, angle, torque]) + [*[3e-3] * 4, 0, 0] * random.standard_normal((rows, 6))
    names = [("tachometer", "rate", "rad/s"), ("encoder", "angle", "rad"), ("drive", "torque", "N m")]
    channels = tuple(
        Channel(name, f"{sensor}{joint}", unit, watch=sensor != "drive")
        for sensor, name, unit in names
        for joint in (1, 2)
    )
    sensors = tuple(Sensor(channel.sensor, dt) for channel in channels)
    return Log(dt * np.arange(rows), value, np.ones(value.shape, bool), channels, sensors)


OBSERVERS = {
    "multistep-observer": functools.partial(
        multistep_observer.build,
        setting=multistep_observer.Setting(steps=(1, 5), horizon_s=3.0, schedule=Schedule(epochs=20, rate=1e-2)),
    ),
    "kinematic-observer": functools.partial(
        kinematic_observer.build, setting=kinematic_observer.Setting((0.2, 1.0, 2.4), horizon_s=3.0)
    ),
}


def observer(name: str) -> Case:
    """An observer of the height in a part of the flight that it was not fitted on; without its inputs there is none."""
    log = flown.flight()
    monitor = OBSERVERS[name](log.between(end_s=160.0), 0, Session()).monitor
    part = log.between(160.0)
    inputs = (flown.DOWN,) if name == "kinematic-observer" else (flown.DOWN, flown.PITCH, flown.THROTTLE)
    return Case(
        name,
        monitor,
        samples(part.time, part.value, part.fresh),
        lie=np.where(np.arange(5) == flown.HEIGHT, 20.0, 0.0),
        back_s=3.0 + 12 * flown.FIX_S + 1.0,
        named=(flown.HEIGHT,),
        lost=dict.fromkeys(inputs, (flown.HEIGHT,)),
    )


def heights() -> Case:
    """Heights and a vertical speed from fix to fix, each fix a beat of its own."""
    log = flown.flight(600.0, hz=1.0)
    monitor = METHODS["height-agreement"].build(log.between(end_s=200.0), 0, Session()).monitor
    part = log.between(200.0)
    every = (flown.HEIGHT, flown.DOWN, flown.BARO)
    return Case(
        "height-agreement",
        monitor,
        samples(part.time, part.value, part.fresh),
        lie=np.where(np.arange(5) == flown.HEIGHT, 60.0, 0.0),
        back_s=80.0,
        named=(flown.HEIGHT,),
        lost={flown.HEIGHT: every},
    )


def whole_drone() -> Case:
    """An aircraft with a gyro. Heights are known only after a minute, so all sensors come at 1 Hz."""
    log = fly(1000.0, seed=2, beat_hz=0.0, imu_hz=1.0, gnss_hz=1.0, barometer_hz=1.0).log
    receiver = [f"gnss.{name}" for name in ("latitude", "longitude", "altitude", "north", "east", "down")]
    log = log.select([*(f"gyro.{axis}" for axis in "xyz"), *receiver, "barometer.altitude"])
    monitor = METHODS["drone"].build(log.between(end_s=600.0), 0, Session()).monitor
    part = log.between(600.0)
    height, place, speeds = [log.index(f"gnss.{name}") for name in ("altitude", "latitude", "north")]
    lost = {
        height: (log.index("gnss.down"), log.index("barometer.altitude")),
        **dict.fromkeys((place, place + 1, speeds, speeds + 1), (place, place + 1)),
    }
    spike = np.where(np.arange(len(log.channels)) < 3, 10.0, 0.0)
    rows = samples(part.time, part.value, part.fresh)
    return Case("drone", monitor, rows, lie=spike, back_s=90.0, named=(0, 1, 2), lost=lost)


def drifting(name: str) -> Case:
    """A test for a slow drift, with a window of 20 s, on two heights at 1 Hz; without the barometer there is none.

    A window holds a fault for its length after the end, and a sum comes down again as slowly.
    """
    log = fly(1000.0, seed=5, beat_hz=0.0, imu_hz=1.0, gnss_hz=1.0, barometer_hz=1.0).log
    log = log.select(["gnss.altitude", "barometer.altitude"])
    setting = replace(DRIFTS[name].setting, window_s=20.0, margin=1.3)
    monitor = drift(log.between(end_s=600.0), replace(DRIFTS[name], setting=setting)).monitor
    part = log.between(600.0)
    rows = samples(part.time, part.value, part.fresh)
    return Case(name, monitor, rows, lie=np.array([500.0, 0.0]), back_s=60.0, named=(0,), lost={1: (0,)})


def follower(name: str) -> Case:
    """A follower and two leaders, all of it at every tick; a range needs both depths, and where its leader is."""
    log = sail(700.0, seed=2, ranging=Ranging(period_s=1.0, lost=0.0, alternating=False), surface_s=np.inf).log
    monitor = METHODS[name].build(log.between(end_s=400.0), 0, Session()).monitor
    part = log.between(399.0)
    ranges = tuple(i for i, channel in enumerate(log.channels) if channel.name == "range")
    own = {at + k: (at,) for at in ranges for k in (1, 2, 3)}
    return Case(
        name,
        monitor,
        samples(part.time, part.value, part.fresh),
        lie=np.where(np.isin(np.arange(len(log.channels)), ranges), 80.0, 0.0),
        back_s=30.0,
        named=ranges,
        lost={log.index("pressure.depth"): ranges, **own},
    )


def _permuted(monitor: Monitor, order: np.ndarray) -> Monitor:
    """The monitor of a joint test and one of repeats, for its channels in another order."""
    residual = (_conditioning if isinstance(monitor.residual, Conditioning) else _reconstruction)(
        monitor.residual, order
    )

    def parts(m: Monitor) -> list:
        joint, each = m.branches
        scale = [joint.statistic.scale] if isinstance(joint.statistic, Exchange) else []
        return [*scale, each.threshold.limit, m.hold_s]

    moved = eqx.tree_at(parts, monitor, [vector[order] for vector in parts(monitor)])
    return replace(moved, residual=residual, owner=tuple(monitor.owner[i] for i in order))


def _reconstruction(residual: Reconstruction, order: np.ndarray) -> Reconstruction:
    vectors = ("offset", "center", "half", "watched")
    return replace(
        residual,
        weights=residual.weights[:, order],
        output=residual.output[order],
        cov=residual.cov[order][:, order],
        **{name: getattr(residual, name)[order] for name in vectors},
    )


def _conditioning(residual: Conditioning, order: np.ndarray) -> Conditioning:
    channels = len(order)
    lagged = np.concatenate([order + lag * channels for lag in range(residual.lags)])
    vectors = ("center", "drift", "most", "watched")
    return replace(
        residual,
        weights=residual.weights[order][:, lagged],
        cov=residual.cov[order][:, order],
        **{name: getattr(residual, name)[order] for name in vectors},
    )


ZOO = {case.name: case for case in zoo()}
MOTION = {name: functools.partial(of_motion, name) for name in ("bicycle-kalman", "side-force")}
DRIFTING = {name: functools.partial(drifting, name) for name in DRIFTS}
HEIGHT = {name: functools.partial(observer, name) for name in OBSERVERS} | {"height-agreement": heights}
# Their parts are those of another recipe of the same file, with another limit.
TWINS = {"chi-square-ckf-01", "chi-square-ackf-05", "anfis-cubature-9m"}
# Their filter is that of lof-efd, and their statistics hold nothing that those of train and the toy guests do not.
TWINS |= {"innovation-chi-square", "averaged-innovation"}
FOLLOWERS = {
    name: functools.partial(follower, name)
    for name in (
        "chi-square-ckf-05",
        "chi-square-ackf-01",
        "double-threshold",
        "anfis-cubature",
        "logistic-cubature",
        "cooperative",
    )
}
ALONE = {
    "motion-deficit": deficit,
    "car": whole_car,
    "drone": whole_drone,
    NETWORK: arm,
    "arm-kalman": two_links,
    **MOTION,
    **HEIGHT,
    **DRIFTING,
    **FOLLOWERS,
    **{name: functools.partial(navigating, name) for name in ("rail", "lof-efd")},
}
JOINT = tuple(name for name in METHODS if name not in {*PREDICTORS, *ALONE, *TWINS})
NAMES = (*ZOO, *JOINT, *PREDICTORS, *ALONE)


@functools.cache
def built(name: str) -> Case:
    """The case of that name, fitted when a law first asks for it."""
    if name in ZOO:
        return ZOO[name]
    if name in ALONE:
        return ALONE[name]()
    return predictor(name) if name in PREDICTORS else joint(name)


def names_with(field: str) -> tuple[str, ...]:
    """Those of the guests whose case has this field, and for `permuted` the joint recipes."""
    have = tuple(name for name, case in ZOO.items() if getattr(case, field))
    return (*have, *JOINT) if field == "permuted" else have
