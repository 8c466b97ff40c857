"""The mission on a real vehicle's paths: its Doppler log and attitude, simulated leaders, errors of real ranges."""

from functools import cache
from pathlib import Path

import numpy as np
import polars as pl
from jaxtyping import Float

from sensorfault.simulation.acoustic import Ranging
from sensorfault.simulation.underwater import Path as Track
from sensorfault.simulation.underwater import mission
from sensorfault_studies.data import real
from sensorfault_studies.xu2023.scenario import DURATION_S, RANGING, Scenario, struck
from sensorfault_studies.xu2023.walks import robust_sd, walks

RUNS, JOINED = 7, 5
SIGMA_M = 3.0


def scenario(seed: int, ranging: Ranging = RANGING) -> Scenario:
    """Five of the seven runs, joined by their true velocities, in an order given by the seed."""
    rng = np.random.default_rng([seed, 7])
    chosen = rng.permutation(RUNS)[:JOINED] + 1
    path, measured = _joined([int(k) for k in chosen])
    spikes = _spikes()
    noisy = Ranging(
        leaders=ranging.leaders,
        period_s=ranging.period_s,
        lost=ranging.lost,
        noise=lambda chance, n: SIGMA_M * chance.choice(spikes, n),
    )
    on_sensors, on_leaders = rng.spawn(2)
    return struck(mission(path, measured, noisy, on_sensors, on_leaders, name=f"AUV {seed}"), seed)


def _joined(chosen: list[int]) -> tuple[Track, Float[np.ndarray, "T 3"]]:
    """The path at 1 Hz, and forward and right velocity and heading as measured by the vehicle."""
    runs = [_run(real("underwater/snapir_auv"), k) for k in chosen]
    velocity, measured, down = (np.concatenate([run[i] for run in runs])[: int(DURATION_S)] for i in range(3))
    time = np.arange(float(len(velocity)))
    place = np.concatenate([np.zeros((1, 2)), np.cumsum(velocity[1:], axis=0)])
    c, s = np.cos(measured[:, 2]), np.sin(measured[:, 2])
    body = np.column_stack([velocity[:, 0] * c + velocity[:, 1] * s, velocity[:, 1] * c - velocity[:, 0] * s])
    return Track(time, np.column_stack([place, down]), body, measured[:, 2]), measured


@cache
def _run(folder: Path, k: int) -> tuple[Float[np.ndarray, "T 2"], Float[np.ndarray, "T 3"], Float[np.ndarray, " T"]]:
    """True velocity north and east, measured velocity and heading, and depth, at whole seconds."""
    truth = pl.read_csv(folder / f"GT_trajectory{k}.csv").to_numpy()
    dvl = pl.read_csv(folder / f"DVL_trajectory{k}.csv").to_numpy()
    at = np.arange(np.floor(min(truth[-1, 0], dvl[-1, 0])))
    north, east, depth = (np.interp(at, truth[:, 0], column) for column in (truth[:, 4], truth[:, 5], -truth[:, 3]))
    forward, right = (np.interp(at, dvl[:, 0], dvl[:, i]) for i in (1, 2))
    heading = np.interp(at, truth[:, 0], np.unwrap(truth[:, 9]))
    return np.column_stack([north, east]), np.column_stack([forward, right, heading]), depth


@cache
def _spikes() -> Float[np.ndarray, " n"]:
    """Errors of real ranges among pedestrians, divided by each anchor's robust sigma, with all outliers."""
    off = [walk.error(anchor) for walk in walks() for anchor in walk.anchors.values()]
    return np.concatenate([(e - np.median(e)) / robust_sd(e) for e in off])
