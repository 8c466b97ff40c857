"""What a log's own past says of a test: the largest change so far, while the vehicle moved no less than now.

A class of vehicles holds good and bad receivers; its limits are wide for the good ones. After some minutes the log
itself shows what is usual for these sensors.
"""

from collections.abc import Iterable

import numpy as np
from jaxtyping import Float, Int

from sensorfault.relations.grid import GRAVITY, STEP_S, Grid
from sensorfault.relations.signals import Signal
from sensorfault.relations.tests_of import Piece

BLOCK_S = 20.0  # largest changes are kept of blocks of this length
LEAST_BLOCKS = 4  # before there are so many, the past says nothing
# Healthy logs of all kinds exceed the largest change of their past at most 3.4 times, if they move no more than in it.
MOST = 4.0
NOVEL = 1.5  # the limits of a class hold for motion that is at most so much more violent than the log's past
STATES = ("gyro", "accelerometer")  # what shows how the vehicle moves
# Kinds whose error nothing here measures: two zeros part by warmth and tilt; a side force shows a turn the worse the
# slower the vehicle is.
UNMEASURED = {"accelerometer|accelerometer", "side"}


def limits(
    piece: Piece, moved: Float[np.ndarray, "T K"], fixed: Float[np.ndarray, " K"], least: Float[np.ndarray, " K"]
) -> Float[np.ndarray, "T K"]:
    """The limit of each test at each tick: the fixed one, or the narrower one that the past shows.

    `moved`: changes without their usual value, in their own units. `least`: no limit by the past lies below. A tick
    knows only blocks that ended before its window began. More violent motion than in the past widens both, by the
    square of how much more (the fixed one beyond NOVEL); no sensor that the test compares measures that motion. Where
    both witnesses moved further than in the past, the narrower one widens by how much further.
    """
    limit = np.broadcast_to(fixed, moved.shape).copy()
    motion = {role: motion_of(piece.grid, role) for role in STATES if role in piece.grid}
    size = round(BLOCK_S / STEP_S)
    block = np.arange(len(moved)) // size
    for (hold, shown), mine in _alike(piece, motion).items():
        now, common = moved[:, mine], piece.common[:, mine]
        past, count = _largest_before(np.abs(now), block, hold)
        if not (count >= LEAST_BLOCKS).any():
            continue
        more = np.ones(now.shape)
        for x in (motion[role] for role in shown):
            known, _ = _largest_before(np.where(np.isfinite(now), x[:, None], np.nan), block, hold)
            more = np.fmax(more, _running_max(x, hold * size)[:, None] / np.maximum(known, 1e-9))
        known, _ = _largest_before(common, block, hold)
        further = np.fmax(1.0, common / np.maximum(known, 1e-9))
        scale = MOST * (1 + 1 / np.maximum(count, 1)) * past * np.fmax(more**2, further)
        beyond = fixed[mine] * np.maximum(more / NOVEL, 1.0) ** 2
        by_past = np.minimum(beyond, np.maximum(scale, least[mine]))
        limit[:, mine] = np.where(count >= LEAST_BLOCKS, by_past, limit[:, mine])
    return limit


def _alike(piece: Piece, motion: Iterable[str]) -> dict[tuple[int, tuple[str, ...]], list[int]]:
    """The tests that wait for as many blocks, and whose motion the same sensors show; none of what nothing shows."""
    found: dict[tuple[int, tuple[str, ...]], list[int]] = {}
    for k, test in enumerate(piece.tests):
        suspects = {device.rstrip("234") for (device, _), _ in test.relation.blame}
        shown = tuple(role for role in motion if role not in suspects)
        if shown and not UNMEASURED & {test.relation.kind, *test.relation.kind.split("|")}:
            found.setdefault((1 + int(np.ceil(test.window_s / BLOCK_S)), shown), []).append(k)
    return found


def _largest_before(
    x: Float[np.ndarray, "T n"], block: Int[np.ndarray, " T"], hold: int
) -> tuple[Float[np.ndarray, "T n"], Int[np.ndarray, "T n"]]:
    """The largest of all blocks that lie `hold` or more before each tick's, and how many they are."""
    starts = np.flatnonzero(np.diff(block, prepend=-1))
    there = np.add.reduceat(np.isfinite(x), starts, axis=0, dtype=int) > 3
    largest = np.where(there, np.fmax.reduceat(x, starts, axis=0), 0.0)
    before = np.maximum(block - hold + 1, 0)
    none = np.zeros((1, x.shape[1]))
    most = np.concatenate([none, np.maximum.accumulate(largest, axis=0)])
    return most[before], np.concatenate([none.astype(int), np.cumsum(there, axis=0)])[before]


def _running_max(x: Float[np.ndarray, " T"], width: int) -> Float[np.ndarray, " T"]:
    """The largest of the last `width` ticks."""
    padded = np.r_[np.full(width - 1, -np.inf), x]
    most = padded
    span = 1
    while 2 * span <= width:
        most = np.maximum(most[:-span], most[span:])
        span *= 2
    return np.asarray(np.maximum(most[: len(x)], most[width - span : width - span + len(x)]))


def motion_of(grid: Grid, role: str, known: Float[np.ndarray, " T"] | None = None) -> Float[np.ndarray, " T"]:
    """How much the vehicle moves by the first sensor of a role: its rms over the last second, without gravity.

    `known`: what it is, so that it need not be worked out.
    """
    return grid.keep(f"motion {role}", lambda: _motion(grid, role) if known is None else known)


def _motion(grid: Grid, role: str) -> Float[np.ndarray, " T"]:
    signal: Signal = grid.signals[role]
    length = np.linalg.norm(signal.value, axis=1)
    square = np.r_[0.0, np.cumsum(np.nan_to_num(length - GRAVITY if role == "accelerometer" else length) ** 2)]
    last = np.searchsorted(signal.time, grid.time, side="right")
    first = np.searchsorted(signal.time, grid.time - 1.0, side="right")
    count = last - first
    return np.where(count > 0, np.sqrt(np.maximum(square[last] - square[first], 0) / np.maximum(count, 1)), 0.0)
