"""A schedule of faults over a log, one at a time, with healthy pauses between them."""

from collections.abc import Iterable, Sequence
from dataclasses import replace

import numpy as np

from sensorfault.faults.fault import KINDS, OFFSETS, SIZELESS, Fault, FaultError, current_kind
from sensorfault.logs.table import Log

# Sizes that are clearly visible but realistic: offsets in sigmas, drift in sigmas per second.
SIZES = {"spike": 10.0, "offset": 5.0, "drift": 0.5, "noise": 3.0, "scale": 2.0, "delay": 1.0}
SIZES |= dict.fromkeys(SIZELESS, 0.0)


def sweep(
    log: Log, kinds: Sequence[str] = KINDS, channels: Sequence[str] | None = None, duration_s: float = 10.0
) -> tuple[Fault, ...]:
    """Every kind on every channel, with the sizes of `SIZES`, not yet scheduled (a spike is one sample).

    `channels`: paths such as `gyro.z`; None: all that a method may judge.

    Raises:
        FaultError: an unknown kind.
        LogError: an unknown channel.
    """
    kinds = [current_kind(kind) for kind in kinds]
    if unknown := [kind for kind in kinds if kind not in KINDS]:
        raise FaultError(f"Fault kind '{unknown[0]}' is unknown; take one of {', '.join(KINDS)}.")
    paths = [c.path for c in log.channels if c.watch] if channels is None else channels
    struck = [log.channels[log.index(path)] for path in paths]
    return tuple(
        Fault(k, c.sensor, c.name, 0.0, 0.0 if k == "spike" else duration_s, SIZES[k], sigmas=k in OFFSETS)
        for k in kinds
        for c in struck
    )


def plan(
    log: Log,
    faults: Iterable[Fault],
    start_s: float = -np.inf,
    end_s: float = np.inf,
    pause_s: float = 10.0,
    seed: int = 0,
) -> tuple[Fault, ...]:
    """Give each fault an onset, in shuffled order, between `start_s` and `end_s` of the log.

    At least `pause_s` healthy seconds lie before the first fault, between two faults and after the last; spare time is
    distributed at random. The given onsets are ignored.

    Raises:
        FaultError: the faults and pauses need more time than there is.
    """
    wanted = list(faults)
    rng = np.random.default_rng(seed)
    begin, end = max(start_s, float(log.time[0])), min(end_s, float(log.time[-1]))
    lasting = np.array([fault.duration_s for fault in wanted])
    needed = float(lasting.sum()) + pause_s * (len(wanted) + 1)
    if needed > end - begin:
        raise FaultError(
            f"{log.name}: {len(wanted)} faults with pauses of {pause_s:g} s need {needed:g} s, but there are "
            f"{max(end - begin, 0.0):g} s; plan fewer or shorter faults."
        )
    order = rng.permutation(len(wanted))
    # Uniform points cut the spare time into n + 1 gaps: onset_i = begin + cut_i + (i + 1) pause + earlier durations.
    cuts = np.sort(rng.uniform(0.0, end - begin - needed, len(wanted)))
    earlier = np.concatenate(([0.0], np.cumsum(lasting[order])))[:-1]
    onsets = begin + cuts + pause_s * np.arange(1, len(wanted) + 1) + earlier
    return tuple(replace(wanted[i], start_s=float(onset)) for i, onset in zip(order, onsets, strict=True))
