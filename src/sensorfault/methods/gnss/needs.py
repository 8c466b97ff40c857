"""What the methods of this family need of a log. Each raises LogError if the log lacks it; nothing is fitted."""

import numpy as np

from sensorfault.logs.epochs import ON_L1, Framing, framing
from sensorfault.logs.satellites import satellites
from sensorfault.logs.table import Log, LogError
from sensorfault.numerics.gnss.position import LEAST

SYSTEMS = {"G": 32, "R": 27, "E": 36, "C": 63, "J": 10}  # satellite numbers of each system
WHEEL = "wheel.speed"
FEW = 60  # epochs needed for a fit


def framed(name: str, log: Log) -> Framing:
    """How the log becomes epochs: a slot for each satellite number of its systems; Dopplers if some are of L1.

    Raises:
        LogError: no satellite has both a corrected pseudorange and a position, or there are too few epochs.
    """
    seen = satellites(log, "".join(SYSTEMS))
    letters = [letter for letter in SYSTEMS if any(one[0] == letter for one in seen.names)]
    most = {letter: max(int(one[1:]) for one in seen.names if one[0] == letter) for letter in letters}
    names = tuple(f"{x}{i:02d}" for x in letters for i in range(1, max(SYSTEMS[x], most[x]) + 1))
    rates = bool(np.isfinite(seen.doppler[:, [one[0] in ON_L1 for one in seen.names]]).any())
    wheel = WHEEL if any(channel.path == WHEEL for channel in log.channels) else ""
    how = framing(log, names, rates, wheel)
    epochs = int((np.isfinite(seen.corrected).sum(axis=1) >= LEAST).sum())
    if epochs < FEW:
        raise LogError(
            f"{log.name} has {epochs} epochs with {LEAST} satellites, but {name} needs {FEW}; give a longer log."
        )
    return how
