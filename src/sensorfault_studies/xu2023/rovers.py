"""The gates on the real robots, as recorded and with frozen or drifting ranges to landmarks."""

from dataclasses import replace
from functools import partial

import jax.numpy as jnp
import numpy as np

from sensorfault.faults.fault import Fault
from sensorfault.faults.inject import inject
from sensorfault.logs.table import Log
from sensorfault.methods.ranging.range_filter import Filter
from sensorfault.stages.residual.cubature import Cubature
from sensorfault.stages.residual.measurement_noise import Stated
from sensorfault.vehicles.rover import Rover
from sensorfault.vehicles.underwater import FollowerRoles, Leader
from sensorfault_studies.xu2023.gates import Watched, early, watching
from sensorfault_studies.xu2023.robots import landmarks, run

METHODS = ("ungated-ackf", "chi-square-ackf-01", "cooperative")
FIRST = (0.05, 0.05, 0.05)  # standard deviations of the initial pose [m], [m], [rad]
LASTS_S, APART_S = 60.0, 20.0  # length of a fault, and time until the next [s]
STALE_S = 10.0  # a landmark not seen for this long is out of sight [s]
FEWEST = 10  # ranges of a landmark during its fault, at least
DRIFT = 0.05  # [m/s]


def watched(robot: int) -> Watched:
    """A robot with the noise from the truth of its first third."""
    own = run(robot)
    log = early(own.case)
    leaders = tuple(Leader(i, ()) for i, channel in enumerate(log.channels) if channel.name == "range")
    every = watching(log, FollowerRoles(leaders), Filter(own.q, own.sigma_m), partial(_cubature, log))
    return Watched(f"robot{robot}", own.case, {method: every[method] for method in METHODS})


def _cubature(log: Log, filter: Filter) -> Cubature:
    """`q` [rad²/s] of the heading is also added to the position [m²/s], as for slip of wheels one metre apart."""
    ranges = tuple(i for i, channel in enumerate(log.channels) if channel.name == "range")
    return Cubature(
        vehicle=Rover(
            landmarks=jnp.asarray(landmarks()),
            q=filter.q * jnp.ones(3),
            first=jnp.asarray(FIRST),
            observed=ranges,
            odometry=(log.index("wheels.forward"), log.index("wheels.turn")),
            pose=(log.index("start.north"), log.index("start.east"), log.index("start.heading")),
        ),
        r=filter.sigma_m**2 * jnp.ones(len(ranges)),
        noise=Stated(filter.adaptive),
        growth=jnp.asarray(filter.growth),
        repeated=jnp.asarray(filter.repeated),
        stale_s=jnp.asarray(STALE_S),
        channels=len(log.channels),
        states=3,
    )


def struck(one: Watched, seed: int) -> Watched:
    """One landmark after the other is faulty for a minute, chosen at random among those with ranges in that time."""
    rng, case = np.random.default_rng([seed, 90]), one.case
    log, names = case.log, [channel.sensor for channel in case.log.channels if channel.name == "range"]
    faults = []
    for k, start in enumerate(np.arange(case.since_s, log.time[-1] - LASTS_S, LASTS_S + APART_S)):
        meanwhile = (log.time >= start) & (log.time < start + LASTS_S)
        received = np.flatnonzero((~np.isnan(case.error[meanwhile])).sum(axis=0) >= FEWEST)
        if len(received):
            kind, size = (("frozen", 0.0), ("drift", DRIFT * float(rng.choice((-1, 1)))))[k % 2]
            faults.append(Fault(kind, names[int(rng.choice(received))], "range", float(start), LASTS_S, size))
    done = inject(log, faults, seed)
    ranges = [i for i, channel in enumerate(log.channels) if channel.name == "range"]
    error = case.error + done.log.value[:, ranges] - log.value[:, ranges]
    return replace(one, case=replace(case, log=done.log, error=error, faults=done.truth))
