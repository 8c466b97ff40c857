"""Faults in what was given as healthy: plain ones are named and left out, so that they are not learned.

Conservative on purpose. A sensor fault begins and ends within one sample and on one sensor; a bump shakes them all. So
looked for are steps from one measurement to the next that stand far out of the noise around them while the other
sensors are calm: two opposite ones make a spike or an offset, one that stays makes an offset to the nearer end. And
runs of exact repeats on a channel that otherwise hardly repeats itself. Drifts, scale and noise are not looked for.
"""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from jaxtyping import Float, Int

from sensorfault.calibration.extremes import tail_limit
from sensorfault.logs.table import Log

LEAST_ROWS = 200
AROUND = 25  # rows in a block of which the usual step is taken
FROZEN_S = 0.5  # shorter repeats are not named
RESTS, RESTING = 5, 0.25  # a channel with more long runs, or a larger share of its rows in them, rests by its nature
ALIKE = 0.5  # two steps are a pair if they differ by less than this share of the larger


@dataclass(frozen=True)
class Suspect:
    """A stretch of one channel that looks faulty: from its first struck row to its last [s]; `reason` in words."""

    start_s: float
    end_s: float
    channel: str
    reason: str

    def as_dict(self) -> dict[str, Any]:
        """For the summary of a model."""
        return asdict(self)


def leave_out(log: Log) -> tuple[Log, tuple[Suspect, ...]]:
    """The log without the rows that look faulty, and what was seen there; the same log if there are none."""
    columns = [i for i, channel in enumerate(log.channels) if channel.watch and _moves(log, i)]
    rows = np.flatnonzero((log.fresh & np.isfinite(log.value))[:, columns].all(axis=1))
    if not columns or len(rows) < LEAST_ROWS:
        return log, ()
    struck = np.zeros(len(log), bool)
    found = []
    for column, (first, end), reason in _spans(log, columns, rows):
        span = slice(rows[first], rows[end - 1] + 1)
        struck[span] = True
        times = log.time[span]
        found.append(Suspect(float(times[0]), float(times[-1]), log.channels[column].path, reason))
    found.sort(key=lambda suspect: (suspect.start_s, suspect.channel))
    return (log.without(np.flatnonzero(struck)) if found else log), tuple(found)


def _moves(log: Log, column: int) -> bool:
    """Whether the channel comes with most ticks and is not constant."""
    there = log.fresh[:, column] & np.isfinite(log.value[:, column])
    return bool(there.mean() >= 0.5) and bool(np.ptp(log.value[there, column]) > 0)


Span = tuple[int, tuple[int, int], str]  # column, rows [first, end) of the complete ones, reason


def _spans(log: Log, columns: list[int], rows: Int[np.ndarray, " N"]) -> list[Span]:
    x, time = log.value[rows][:, columns], log.time[rows]
    period = float(np.median(np.diff(time)))
    step = np.diff(x, axis=0)
    sensors = np.array([log.channels[i].sensor for i in columns])
    strange = isolation(step, sensors)
    found: list[Span] = []
    for k, column in enumerate(columns):
        frozen = _frozen(x[:, k], max(round(FROZEN_S / period), 4))
        found += [(column, run, "frozen") for run in frozen]
        limit = tail_limit(strange[:, k], len(columns))
        steps = {
            int(at): float(step[at, k])
            for at in np.flatnonzero(strange[:, k] > limit / 2)
            if not any(first - 1 <= at <= end for first, end in frozen)
        }
        certain = set(np.flatnonzero(strange[:, k] > limit).tolist())
        found += [(column, span, reason) for span, reason in _offsets(steps, certain, x[:, k])]
    return found


def isolation(step: Float[np.ndarray, "N C"], sensors: np.ndarray) -> Float[np.ndarray, "N C"]:
    """Size of each step over the usual one around it, and over the same measure of the other sensors' steps."""
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
    """Median step of the block that a row is in or of a neighbouring one, whichever is largest."""
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
    """Spikes, offsets between two opposite steps, steps that stay; a step at `at` leads from row at to row at + 1."""
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
        if not _stays(x, at, stays[at], len(x)):  # it ended where nobody saw it
            continue
        found.append(((at + 1, len(x)) if at >= len(x) / 2 else (0, at + 1), "offset"))
    return found


def _opposite(one: float, other: float) -> bool:
    """Whether one step takes back the other."""
    return one * other < 0 and abs(one + other) < ALIKE * max(abs(one), abs(other))


def _stays(x: Float[np.ndarray, " N"], at: int, size: float, near: int = AROUND) -> bool:
    """Whether the level of the `near` rows before and of those after differs by about the step."""
    before, after = x[max(at + 1 - near, 0) : at + 1], x[at + 1 : at + 1 + near]
    return abs(float(np.median(after) - np.median(before)) - size) < ALIKE * abs(size)


def _frozen(x: Float[np.ndarray, " N"], least: int) -> list[tuple[int, int]]:
    """Runs of exact repeats too long for chance, rows [first, end); none for a channel that rests now and then.

    A wheel at rest reads exactly 0, a command stays where it was put.
    """
    changed = np.concatenate([[0], np.flatnonzero(np.diff(x) != 0) + 1, [len(x)]])
    length = np.diff(changed)
    long = length > least
    rests = (x[changed[:-1]][long] == 0).any() or long.sum() > RESTS or length[long].sum() > RESTING * len(x)
    if rests:
        return []
    short = length[~long]
    # Of repeats independent of chance p, a run of n comes about N p^n times.
    p = ((short - 1).sum() + 3) / max(short.sum(), 1)
    chance = np.log(1e-3 / len(x)) / np.log(min(p, 0.999))
    enough = max(chance, 4.0 * short.max(initial=1))
    return [(int(changed[i]) + 1, int(changed[i + 1])) for i in np.flatnonzero(long & (length > enough))]
