"""Runs of a real arm: six joints of a Schunk arm, 4 ms. Read directly from the archive.

Measured for S. Liu & M. Althoff, Reachset conformance of forward dynamic models for the formal analysis of robots (IROS
2018). The rates were smoothed offline: angle and rate of a joint are not independent sensors.
"""

import io
import re
import tarfile
from pathlib import Path

import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import Log, LogError, Sensor
from sensorfault.simulation.arm import channels

ARCHIVE = "schunk_arm.tar.gz"
PERIOD_S = 0.004
JOINTS = 6
_FILE = re.compile(r"Robot/(?P<run>measurement_\d+)/(?P<what>time|trajectory|input)\.csv")


def runs(archive: Path) -> tuple[Log, ...]:
    """All runs, in the order of their numbers.

    Raises:
        LogError: the archive does not exist, or a run does not have the format of its readme.
    """
    found: dict[str, dict[str, Float[np.ndarray, "T n"]]] = {}
    try:
        with tarfile.open(archive) as tar:
            for member in tar:
                name, file = _FILE.fullmatch(member.name), tar.extractfile(member)
                if name and file:
                    table = np.loadtxt(io.BytesIO(file.read()), delimiter=",", ndmin=2)
                    found.setdefault(name["run"], {})[name["what"]] = table
    except (OSError, tarfile.TarError) as error:
        raise LogError(f"{archive}: cannot be read ({error}); give the archive of the Schunk arm's runs.") from None
    if not found:
        raise LogError(f"{archive}: has no runs in it; give the archive of the Schunk arm's runs.")
    return tuple(_log(run, found[run]) for run in sorted(found, key=lambda run: int(run.split("_")[1])))


def _log(run: str, tables: dict[str, Float[np.ndarray, "T n"]]) -> Log:
    """Torques have one row less: nothing was commanded at the last tick."""
    empty = np.empty((0, 0))
    time, trajectory, torque = (tables.get(what, empty) for what in ("time", "trajectory", "input"))
    rows = len(time)
    if not rows or trajectory.shape != (rows, 2 * JOINTS) or torque.shape != (rows - 1, JOINTS):
        raise LogError(
            f"{run}: time, trajectory and input have {time.shape}, {trajectory.shape} and {torque.shape} numbers; give "
            f"a trajectory of {2 * JOINTS} columns with as many rows, and an input of {JOINTS} with one less."
        )
    angles, rates = trajectory[:, :JOINTS], trajectory[:, JOINTS:]
    value = np.concatenate([rates, angles, np.vstack([torque, np.full(JOINTS, np.nan)])], axis=1)
    columns = channels(JOINTS)
    sensors = tuple(Sensor(channel.sensor, PERIOD_S) for channel in columns)
    return Log(time[:, 0], value, np.isfinite(value), columns, sensors, run.replace("_", " "))
