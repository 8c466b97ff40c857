"""Inject many faults into one healthy log and measure which a model detects, by kind, channel and magnitude."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from sensorfault.core.expect import LOG, MODEL, expect
from sensorfault.evaluation.cells import Cell, tabulate
from sensorfault.evaluation.judge import Judgement, Outcome, judge
from sensorfault.evaluation.ranking import auc, auc_pr
from sensorfault.faults.fault import OFFSETS, Fault
from sensorfault.faults.inject import inject
from sensorfault.faults.plan import plan
from sensorfault.logs.rates import MISSED
from sensorfault.logs.table import Log, LogError
from sensorfault.runtime.detect import detect
from sensorfault.runtime.model import Model

PAUSE_S = 5.0  # between two faults
MAGNITUDES = {  # of the injected faults, in the unit of the kind: sigmas, sigmas a second, factor, or seconds
    "spike": (3.0, 10.0, 20.0),
    "offset": (3.0, 10.0, 20.0),
    "drift": (1.0, 3.0),
    "frozen": (0.0,),
    "missing": (0.0,),
    "noise": (3.0, 10.0),
    "scale": (2.0, 5.0),
    "delay": (0.5, 2.0),
}


@dataclass(frozen=True)
class Campaign:
    """The recall table, all outcomes, the run without faults, and how well the first test ranks samples."""

    cells: tuple[Cell, ...]
    outcomes: tuple[Outcome, ...]
    untouched: Judgement
    auc: float
    auc_pr: float

    def isolation(self) -> dict[str, dict[str, int]]:
        """Confusion of sensors, detected faults only: counts[faulty sensor][isolated sensor]."""
        counts: dict[str, dict[str, int]] = {}
        for outcome in self.outcomes:
            if outcome.named is not None:
                row = counts.setdefault(outcome.fault.sensor, {})
                name = outcome.named.sensor or "unknown which"
                row[name] = row.get(name, 0) + 1
        return counts


def campaign(
    model: Model,
    log: Log,
    kinds: Sequence[str] = tuple(MAGNITUDES),
    duration_s: float = 5.0,
    repeats: int = 3,
    seed: int = 0,
    progress: Callable[[float], None] | None = None,
) -> Campaign:
    """Inject each kind on each watched channel at each magnitude `repeats` times into a healthy log, and evaluate.

    The model must not be fitted on this log; its limits stay as they are.

    Raises:
        LogError: the log is too short for one fault, the kind is unknown, or the duration is not positive.
        TypeError: something else than a model or a log.
    """
    expect(model, Model, "campaign: model", MODEL)
    expect(log, Log, "campaign: log", LOG)
    if unknown := [kind for kind in kinds if kind not in MAGNITUDES]:
        raise LogError(f"fault kind '{unknown[0]}' is unknown; take some of {', '.join(MAGNITUDES)}.")
    if not duration_s > 0:
        raise LogError(f"the fault duration is {duration_s:g} s; give a duration above 0.")
    log = model.take(log)
    at_once = int((log.duration_s - PAUSE_S) / (duration_s + PAUSE_S))
    if at_once < 1:
        raise LogError(
            f"{log.name} has {log.duration_s:.0f} s, but a fault of {duration_s:g} s with pauses needs "
            f"{duration_s + 2 * PAUSE_S:.0f} s; give a longer part, or shorter faults."
        )
    clean = detect(model, log)
    wanted = list(_wanted(model, kinds, duration_s)) * repeats
    order = np.random.default_rng(seed).permutation(len(wanted))
    batches = [[wanted[i] for i in order[n : n + at_once]] for n in range(0, len(order), at_once)]
    outcomes: list[Outcome] = []
    ranked: list[tuple[np.ndarray, np.ndarray]] = []
    for i, batch in enumerate(batches):
        injected = inject(log, plan(log, batch, pause_s=PAUSE_S, seed=seed + i), seed)
        found = detect(model, injected.log)
        outcomes += judge(found, injected.truth, log).outcomes
        ranked.append((found.traces[0].score, np.asarray(injected.mask.any(axis=1))))
        if progress:
            progress((i + 1) / len(batches))
    score, faulty = (np.concatenate(parts) for parts in zip(*ranked, strict=True))
    tested = np.isfinite(score)
    return Campaign(
        cells=tabulate(outcomes, clean),
        outcomes=tuple(outcomes),
        untouched=judge(clean, ()),
        auc=auc(score[tested], faulty[tested]),
        auc_pr=auc_pr(score[tested], faulty[tested]),
    )


def _wanted(model: Model, kinds: Sequence[str], duration_s: float) -> Iterator[Fault]:
    """Every kind on every watched channel at every magnitude; `missing` silences a whole sensor, watched or not."""
    watched = [channel for channel, watch in zip(model.channels, model.watched, strict=True) if watch]
    for kind in kinds:
        lasting = 0.0 if kind == "spike" else duration_s
        if kind == "missing":
            noticeable = (sensor for sensor in model.sensors if MISSED * sensor.period_s < lasting)
            yield from (Fault(kind, sensor.name, None, 0.0, lasting) for sensor in noticeable)
            continue
        for size in MAGNITUDES[kind]:
            for channel in watched:
                yield Fault(kind, channel.sensor, channel.name, 0.0, lasting, size, kind in OFFSETS)
