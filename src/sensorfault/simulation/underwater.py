"""A simulated mission under water: a follower with dead reckoning and ranges to its leaders."""

from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import Channel, Log, Sensor
from sensorfault.numerics.geodesy import ecef_to_geodetic, enu_to_ecef
from sensorfault.simulation.acoustic import Ranging, hear
from sensorfault.simulation.noise import gauss_markov, smooth

GPS_SD = 1.27  # of latitude and longitude each: 1.8 m together [m]
DVL_WHITE, DVL_BIAS, DVL_SCALE = 0.1, 0.02, 0.005  # [m/s], [m/s], of the speed; 0.2 kn are 0.1 m/s
COMPASS_SD, COMPASS_BIAS = np.deg2rad(0.3), np.deg2rad(1.0)
DEPTH_SD = 0.1  # [m]
ORIGIN_DEG = (45.76, 126.63)
TWO = Ranging()
FOLLOWER = (
    Channel("latitude", "gps", "deg", watch=False),
    Channel("longitude", "gps", "deg", watch=False),
    Channel("forward", "dvl", "m/s", watch=False),
    Channel("right", "dvl", "m/s", watch=False),
    Channel("heading", "compass", "deg", watch=False),
    Channel("depth", "pressure", "m", watch=False),
)


@dataclass(frozen=True)
class Path:
    """Motion of a follower: T ticks; north, east, down of the start [m]; forward and right [m/s]; heading [rad]."""

    time: Float[np.ndarray, " T"]
    position: Float[np.ndarray, "T 3"]
    velocity: Float[np.ndarray, "T 2"]
    heading: Float[np.ndarray, " T"]


@dataclass(frozen=True)
class Mission:
    """The measurements and the truth; `truth` has a true value of every channel at every tick."""

    log: Log
    truth: Log
    path: Path


def sail(
    duration_s: float = 1700.0,
    seed: int = 0,
    ranging: Ranging = TWO,
    surface_s: float = 0.0,
) -> Mission:
    """A follower at 1 to 2 m/s on winding courses, sampled at 1 Hz; GPS at the first tick and up to `surface_s`.

    Sensors: `gps`, `dvl`, `compass`, `pressure` (depth) and `leader1`, `leader2`, ... with the range, the leader's
    reported position, and its depth. The same seed gives the same mission.

    Raises:
        ValueError: less than two ticks.
    """
    if not duration_s >= 2:
        raise ValueError(f"A mission of {duration_s:g} s at 1 Hz has fewer than two samples; make it longer.")
    on_path, on_sensors, on_leaders = np.random.default_rng(seed).spawn(3)
    path = wind(np.arange(float(round(duration_s))), on_path)
    said = measure(path, on_sensors)
    return mission(path, said, ranging, on_sensors, on_leaders, surface_s, f"mission {seed}")


def wind(time: Float[np.ndarray, " T"], rng: np.random.Generator) -> Path:
    """Winding courses at 1 to 2 m/s, about 20 m deep."""
    n = len(time)
    slowly = [smooth(gauss_markov(rng, n, 1.0, tau), 60) for tau in (120.0, 200.0, 60.0, 300.0)]
    forward = np.clip(1.5 + 0.3 * slowly[0], 1.0, 2.0)
    right = 0.05 * slowly[2]
    heading = rng.uniform(0, 2 * np.pi) + 1.2 * slowly[1]
    c, s = np.cos(heading), np.sin(heading)
    rate = np.stack([forward * c - right * s, forward * s + right * c], axis=1)
    way = np.concatenate([np.zeros((1, 2)), np.cumsum(rate[1:] * np.diff(time)[:, None], axis=0)])
    return Path(time, np.column_stack([way, 20 + 3 * slowly[3]]), np.stack([forward, right], axis=1), heading)


def measure(path: Path, rng: np.random.Generator) -> Float[np.ndarray, "T 3"]:
    """Measurements of Doppler log and compass: forward, right [m/s], heading [rad]."""
    n = len(path.time)
    bias = DVL_BIAS * rng.standard_normal(2)
    velocity = path.velocity * (1 + DVL_SCALE * rng.standard_normal()) + bias + DVL_WHITE * rng.standard_normal((n, 2))
    off = COMPASS_BIAS * rng.standard_normal() + COMPASS_SD * gauss_markov(rng, n, 1.0, 60.0)
    return np.column_stack([velocity, path.heading + off])


def mission(
    path: Path,
    said: Float[np.ndarray, "T 3"],
    ranging: Ranging,
    on_sensors: np.random.Generator,
    on_leaders: np.random.Generator,
    surface_s: float = 0.0,
    name: str = "mission",
) -> Mission:
    """The log of a follower on this path with these Doppler and compass measurements; the leaders are simulated."""
    received = hear(path.time, path.position, ranging, on_leaders)
    n = len(path.time)
    place = path.position[:, :2] + GPS_SD * on_sensors.standard_normal((n, 2))
    depth = path.position[:, 2] + DEPTH_SD * on_sensors.standard_normal(n)
    heading = np.mod(said[:, 2], 2 * np.pi)
    value = np.column_stack([geodetic(place), said[:, :2], heading, depth, _leaders(received.result, received.range)])
    true = np.column_stack(
        [
            geodetic(path.position[:, :2]),
            path.velocity,
            np.mod(path.heading, 2 * np.pi),
            path.position[:, 2],
            _leaders(received.position, received.true),
        ]
    )
    fresh = np.ones(value.shape, bool)
    fresh[:, :2] = (path.time <= path.time[0] + surface_s)[:, None]
    fresh[:, len(FOLLOWER) :] = np.repeat(received.received, 4, axis=1)
    log = Log(path.time, np.where(fresh, value, np.nan), fresh, _channels(ranging), _sensors(ranging), name)
    return Mission(log, replace(log, value=true, fresh=np.ones_like(fresh), name=f"{name}, truth"), path)


def geodetic(place: Float[np.ndarray, "T 2"]) -> Float[np.ndarray, "T 2"]:
    """Latitude and longitude [rad] of points north and east of the origin [m], on the ellipsoid."""
    lat, lon = np.deg2rad(ORIGIN_DEG)
    # the tangent plane leaves the ellipsoid by d² / 2R, 0.1 m over a kilometre: two rounds bring the point back to it
    up = np.zeros(len(place))
    for _ in range(2):
        latitude, longitude, height = ecef_to_geodetic(
            enu_to_ecef(np.column_stack([place[:, ::-1], up]), float(lat), float(lon), 0.0)
        )
        up = up - height
    return np.stack([latitude, longitude], axis=1)


def _leaders(position: Float[np.ndarray, "T L 3"], range_m: Float[np.ndarray, "T L"]) -> Float[np.ndarray, "T k"]:
    """Range, latitude, longitude and depth of each leader, side by side."""
    each = [
        np.column_stack([range_m[:, j], geodetic(position[:, j, :2]), position[:, j, 2]])
        for j in range(position.shape[1])
    ]
    return np.concatenate(each, axis=1)


def _names(ranging: Ranging) -> list[str]:
    return [f"leader{j + 1}" for j in range(ranging.leaders)]


def _channels(ranging: Ranging) -> tuple[Channel, ...]:
    result = (("range", "m", True), ("latitude", "deg", False), ("longitude", "deg", False), ("depth", "m", False))
    return (*FOLLOWER, *(Channel(what, name, unit, watch) for name in _names(ranging) for what, unit, watch in result))


def _sensors(ranging: Ranging) -> tuple[Sensor, ...]:
    own = [Sensor(name, 1.0) for name in dict.fromkeys(channel.sensor for channel in FOLLOWER)]
    return (*own, *(Sensor(name, ranging.period_s) for name in _names(ranging)))
