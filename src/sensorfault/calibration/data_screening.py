"""Screening of training data: gross faults in data given as healthy are listed and removed, so they are not learned.

Conservative on purpose. A sensor fault starts and ends within one sample and on one sensor; a bump shakes all sensors.
The screening looks for steps between two measurements that are far above the noise around them while the other sensors
are calm. Two opposite steps are a spike or an offset; a single step that stays is an offset to the nearer end of the
log. It also looks for runs of exact repeats on a channel that otherwise hardly repeats. It does not look for drift,
scale or noise faults.
"""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from sensorfault.calibration.extremes import tail_limit
from sensorfault.logs.table import Log

LEAST_ROWS = 200
AROUND = 25  # rows of a block; the median step of a block measures the noise
FROZEN_S = 0.5  # shorter runs of repeats are ignored [s]
RESTS, RESTING = 5, 0.25  # a channel with more long runs, or a larger share of rows in them, is often at rest
ALIKE = 0.5  # two steps are a pair if they differ by less than this share of the larger


@dataclass(frozen=True)
class Suspect:
    """A stretch of one channel that looks faulty, from first to last removed row [s]; `reason`: kind of fault."""

    start_s: float
    end_s: float
    channel: str
    reason: str

    def as_dict(self) -> dict[str, Any]:
        """For the summary of a model."""
        return asdict(self)


def leave_out(log: Log) -> tuple[Log, tuple[Suspect, ...]]:
    """The log without the rows that look faulty, and the suspect stretches; the same log if there are none."""
    columns = [i for i, channel in enumerate(log.channels) if channel.watch and _moves(log, i)]
    rows = np.flatnonzero((log.fresh & np.isfinite(log.value))[:, columns].all(axis=1))
    if not columns or len(rows) < LEAST_ROWS:
        return log, ()
    excluded = np.zeros(len(log), bool)
    found = []
    for column, (first, end), reason in _spans(log, columns, rows):
        span = slice(rows[first], rows[end - 1] + 1)
        excluded[span] = True
        times = log.time[span]
        found.append(Suspect(float(times[0]), float(times[-1]), log.channels[column].path, reason))
    found.sort(key=lambda suspect: (suspect.start_s, suspect.channel))
    return (log.without(np.flatnonzero(excluded)) if found else log), tuple(found)


def _moves(log: Log, column: int) -> bool:
    """Whether the channel has a value in most ticks and is not constant."""
    there = log.fresh[:, column] & np.isfinite(log.value[:, column])
    return bool(there.mean() >= 0.5) and bool(np.ptp(log.value[there, column]) > 0)


Span = tuple[int, tuple[int, int], str]  # column, rows [first, end) of the complete ones, reason


def _spans(log: Log, columns: list[int], rows: Int[np.ndarray, " N"]) -> list[Span]:
    x, time = log.value[rows][:, columns], log.time[rows]
    period = float(np.median(np.diff(time)))
    step = np.diff(x, axis=0)
    sensors = np.array([log.channels[i].sensor for i in columns])
    isolated = isolation(step, sensors)
    found: list[Span] = []
    for k, column in enumerate(columns):
        frozen = _frozen(x[:, k], max(round(FROZEN_S / period), 4))
        found += [(column, run, "frozen") for run in frozen]
        limit = tail_limit(isolated[:, k], len(columns))
        steps = {
            int(at): float(step[at, k])
            for at in np.flatnonzero(isolated[:, k] > limit / 2)
            if not any(first - 1 <= at <= end for first, end in frozen)
        }
        certain = set(np.flatnonzero(isolated[:, k] > limit).tolist())
        found += [(column, span, reason) for span, reason in _offsets(steps, certain, x[:, k])]
    return found


def isolation(step: Float[np.ndarray, "N C"], sensors: np.ndarray) -> Float[np.ndarray, "N C"]:
    """Size of each step relative to the usual step around it, divided by the same measure of the other sensors."""
    size = np.abs(step)
    usual = _usual(size)
    overall = np.median(size, axis=0)
    noisy = size / np.maximum(usual, np.where(overall > 0, overall, np.inf) / 2)
    alone: Float[np.ndarray, "N C"] = noisy.copy()
    for sensor in dict.fromkeys(sensors):
        own = sensors == sensor
        if own.all():
            continue
        others = noisy[:, ~own].max(axis=1)
        others = np.maximum.reduce([others, np.append(others[1:], 0.0), np.append(0.0, others[:-1])])
        alone[:, own] = noisy[:, own] / np.maximum(others, 1.0)[:, None]
    return alone


def _usual(size: Float[np.ndarray, "N C"]) -> Float[np.ndarray, "N C"]:
    """Median step of each row's block or of a neighbouring block, whichever is largest."""
    blocks = max(len(size) // AROUND, 1)
    parts = np.array_split(size, blocks)
    median = np.array([np.median(part, axis=0) for part in parts])
    after, before = np.vstack([median[1:], median[-1:]]), np.vstack([median[:1], median[:-1]])
    largest = np.maximum.reduce([median, after, before])
    usual: Float[np.ndarray, "N C"] = np.repeat(largest, [len(part) for part in parts], axis=0)
    return usual


def _offsets(
    steps: dict[int, float], certain: set[int], x: Float[np.ndarray, " N"]
) -> list[tuple[tuple[int, int], str]]:
    """Spikes, offsets between two opposite steps, and steps that stay; step `at` is from row at to row at + 1."""
    found: list[tuple[tuple[int, int], str]] = []
    left = dict(steps)
    for at in sorted(steps):
        if at in left and at + 1 in left and {at, at + 1} & certain and _opposite(left[at], left[at + 1]):
            found.append(((at + 1, at + 2), "spike"))
            del left[at], left[at + 1]
    stays = {at: size for at, size in left.items() if _stays(x, at, size)}
    for at in sorted(stays):
        if at not in stays:
            continue
        pairs = (back for back in sorted(stays) if back > at and _opposite(stays[at], stays[back]))
        back = next(pairs, None)
        if back is not None and {at, back} & certain:
            found.append(((at + 1, back + 1), "offset"))
            del stays[at], stays[back]
    for at in sorted(stays.keys() & certain):
        if not _stays(x, at, stays[at], len(x)):  # its end was not seen
            continue
        found.append(((at + 1, len(x)) if at >= len(x) / 2 else (0, at + 1), "offset"))
    return found


def _opposite(one: float, other: float) -> bool:
    """Whether one step cancels the other."""
    return one * other < 0 and abs(one + other) < ALIKE * max(abs(one), abs(other))


def _stays(x: Float[np.ndarray, " N"], at: int, size: float, near: int = AROUND) -> bool:
    """Whether the median of the `near` rows after the step differs from that before by about the step."""
    before, after = x[max(at + 1 - near, 0) : at + 1], x[at + 1 : at + 1 + near]
    return abs(float(np.median(after) - np.median(before)) - size) < ALIKE * abs(size)


def _frozen(x: Float[np.ndarray, " N"], least: int) -> list[tuple[int, int]]:
    """Runs of exact repeats too long for chance, rows [first, end); none for a channel that is at rest now and then.

    A wheel at rest reads exactly 0, and a command keeps its value.
    """
    changed = np.concatenate([[0], np.flatnonzero(np.diff(x) != 0) + 1, [len(x)]])
    length = np.diff(changed)
    long = length > least
    rests = (x[changed[:-1]][long] == 0).any() or long.sum() > RESTS or length[long].sum() > RESTING * len(x)
    if rests:
        return []
    short = length[~long]
    # If repeats are independent with probability p, about N p^n runs of length n occur.
    p = ((short - 1).sum() + 3) / max(short.sum(), 1)
    chance = np.log(1e-3 / len(x)) / np.log(min(p, 0.999))
    enough = max(chance, 4.0 * short.max(initial=1))
    return [(int(changed[i]) + 1, int(changed[i + 1])) for i in np.flatnonzero(long & (length > enough))]
