"""The filter of a two-joint arm."""

import numpy as np

from laws.case import Case
from sensorfault.methods.catalog import METHODS
from sensorfault.runtime.runners import samples
from sensorfault.simulation.arm import PERIOD_S, run
from sensorfault.training.session import Session


def two_links() -> Case:
    """The filter of a two-joint arm."""
    monitor = METHODS["arm-kalman"].build(run(seed=1), 0, Session()).monitor
    log = run(seed=2, samples=400)
    lie = np.array([0.5, 0.5, 0.5, 0.5, 0.0, 0.0])
    rows = samples(log.time, log.value, log.fresh)
    return Case("arm-kalman", monitor, rows, lie, 5 * PERIOD_S, named=(0, 1, 2, 3))


CASES = {"arm-kalman": two_links}
