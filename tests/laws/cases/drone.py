"""The recipe of a whole aircraft."""

import numpy as np

from laws.case import Case
from sensorfault.methods.catalog import METHODS
from sensorfault.runtime.runners import samples
from sensorfault.simulation.flapping_wing import fly
from sensorfault.training.session import Session


def whole_drone() -> Case:
    """An aircraft with a gyro. Heights are known only after a minute, so all sensors come at 1 Hz."""
    log = fly(1000.0, seed=2, beat_hz=0.0, imu_hz=1.0, gnss_hz=1.0, barometer_hz=1.0).log
    receiver = [f"gnss.{name}" for name in ("latitude", "longitude", "altitude", "north", "east", "down")]
    log = log.select([*(f"gyro.{axis}" for axis in "xyz"), *receiver, "barometer.altitude"])
    monitor = METHODS["drone-composite"].build(log.between(end_s=600.0), 0, Session()).monitor
    part = log.between(600.0)
    height, place, speeds = [log.index(f"gnss.{name}") for name in ("altitude", "latitude", "north")]
    lost = {
        height: (log.index("gnss.down"), log.index("barometer.altitude")),
        **dict.fromkeys((place, place + 1, speeds, speeds + 1), (place, place + 1)),
    }
    spike = np.where(np.arange(len(log.channels)) < 3, 10.0, 0.0)
    rows = samples(part.time, part.value, part.fresh)
    return Case("drone-composite", monitor, rows, lie=spike, back_s=90.0, named=(0, 1, 2), lost=lost)


CASES = {"drone-composite": whole_drone}
