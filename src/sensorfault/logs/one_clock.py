"""Puts several files on one clock: the ticks are those of the fastest file, and no value arrives before its time."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.logs.pauses import GAP, Pauses, gaps_said, shared_pauses
from sensorfault.logs.phrase import counted
from sensorfault.logs.resample import Resample
from sensorfault.logs.stream import Stream

MOST_FILLED, PER_ROW = 100_000, 10  # most ticks put into gaps, or this many per row; more means that a clock has jumped
SAME_S = 1e-6  # times of two clocks closer than this are equal


@dataclass(frozen=True)
class OneClock:
    """T ticks; `value` and `fresh` have the streams' channels side by side. `zero_s`: the clock's reading at time 0."""

    zero_s: float
    time: Float[np.ndarray, " T"]
    value: Float[np.ndarray, "T C"]
    fresh: Bool[np.ndarray, "T C"]
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Piece:
    """A piece of a longer log. `ticks`: the stream whose rows are the ticks. `begin_s`: clock at the log's start.

    `first`, `last`: whether the piece has the log's first and last rows; else rows outside its ticks are not lost.
    `since_s`: gaps before this reading of the clock were in the piece before.
    """

    ticks: Stream
    begin_s: float
    first: bool
    last: bool
    since_s: float = -np.inf


def put_on_one_clock(streams: list[Stream], resample: Resample = "hold", piece: Piece | None = None) -> OneClock:
    """Put every stream on the ticks of the fastest.

    A slower stream's row goes to the first tick at or after its own time; of two rows for one tick the later stays.
    Where the fastest file has a gap, ticks continue with its usual period, so that the dropout can be detected; but
    not in a pause of the whole recording.
    """
    if len(streams) == 1 and resample == "hold":
        (only,) = streams
        return OneClock(only.zero_s, only.time, only.value, only.fresh)
    if piece is None:
        fastest = min(streams, key=lambda stream: stream.pace_s)
        piece = Piece(fastest, fastest.zero_s, first=True, last=True)
    fastest = piece.ticks
    times = [stream.time + (stream.zero_s - fastest.zero_s) for stream in streams]
    at, notes = _ticks(streams, times, piece) if len(streams) > 1 else (fastest.time, [])
    shape = (len(at), sum(stream.value.shape[1] for stream in streams))
    value, fresh, begin = np.full(shape, np.nan), np.zeros(shape, bool), 0
    for stream, time in zip(streams, times, strict=True):
        own = slice(begin, begin + stream.value.shape[1])
        if resample == "linear":
            value[:, own], fresh[:, own] = _interpolated(at, time, stream)
        else:
            notes += _place(at, time, stream, piece, value[:, own], fresh[:, own])
        begin = own.stop
    return OneClock(fastest.zero_s, at, value, fresh, tuple(notes))


def _ticks(streams: list[Stream], times: list[np.ndarray], piece: Piece) -> tuple[np.ndarray, list[str]]:
    """The ticks, and sentences on the gaps of each file. States are written when they change: they know no gaps."""
    steady = [(stream, time) for stream, time in zip(streams, times, strict=True) if stream.measured]
    begin, since_s = piece.begin_s - piece.ticks.zero_s, piece.since_s - piece.begin_s
    pauses = shared_pauses([time for _, time in steady], [one.period_s for one, _ in steady], piece.ticks.period_s)
    at, notes = _filled(piece, pauses)
    for one, time in steady:
        notes += gaps_said(one.name, time - begin, one.period_s, pauses - begin, since_s)
    return at, notes


def _filled(piece: Piece, pauses: Pauses) -> tuple[np.ndarray, list[str]]:
    """The ticks, one where a pause begins and ends, and new ones inside each gap that is no pause.

    None where the clock jumps too far, which a note says.
    """
    period, begin = piece.ticks.period_s, piece.begin_s - piece.ticks.zero_s
    first, last = piece.ticks.time[[0, -1]]
    pauses = pauses[(pauses[:, 0] > first - SAME_S) & (pauses[:, 1] < last + SAME_S)]
    time = _with(piece.ticks.time, pauses.ravel())
    step = np.diff(time)
    paused = np.zeros(len(step), bool)
    paused[np.searchsorted(time, pauses[:, 0] - SAME_S)] = True
    gaps = np.flatnonzero((step > GAP * period) & ~paused)
    count = np.round(step[gaps] / period) - 1
    shortest = np.argsort(count, kind="stable")
    filled = np.zeros(len(gaps), bool)
    filled[shortest] = np.cumsum(count[shortest]) <= max(MOST_FILLED, PER_ROW * len(time))
    new = [
        time[i] + step[i] * np.arange(1, ticks + 1) / (ticks + 1)
        for i, ticks in zip(gaps[filled], count[filled], strict=True)
    ]
    notes = [
        f"{piece.ticks.name}: its clock jumps by {step[i]:.6g} s at {time[i] - begin:.3f} s, too far for a gap in a "
        f"log of {len(time)} rows; no ticks were put there."
        for i in gaps[~filled][:1]
    ]
    return np.sort(np.concatenate([time, *new])), notes


def _with(time: np.ndarray, others: np.ndarray) -> np.ndarray:
    """The times and those others, all between the first and the last time, that are none of them."""
    near = np.minimum(np.searchsorted(time, others - SAME_S), len(time) - 1)
    new = others[time[near] > others + SAME_S]
    return np.sort(np.concatenate([time, new])) if len(new) else time


def _place(
    ticks: np.ndarray, time: np.ndarray, stream: Stream, piece: Piece, value: np.ndarray, fresh: np.ndarray
) -> list[str]:
    """Put each row on the first tick at or after its time; `value` and `fresh` are empty before."""
    # Rows of the fastest stream lie exactly on ticks; a row long before the first tick is not new at it.
    tick = np.searchsorted(ticks, time - SAME_S, side="left")
    early, late = time <= ticks[0] - (stream.period_s if piece.first else SAME_S), tick == len(ticks)
    early &= stream.measured or not piece.first  # what is said of the vehicle holds until something else is
    rows = np.flatnonzero(~(early | late))
    outside = int((early & piece.first | late & piece.last).sum())
    last = np.append(tick[rows][1:] != tick[rows][:-1], True) if len(rows) else np.zeros(0, bool)
    later = rows[last]
    value[tick[later]], fresh[tick[later]] = stream.value[later], stream.fresh[later]
    # A row that was dropped for a later one on the same tick still made the tick new.
    dropped = rows[~last]
    at = tick[dropped]
    np.logical_or.at(fresh, at, stream.fresh[dropped])
    fresh[at] &= np.isfinite(value[at])
    notes: list[str] = []
    if not stream.measured:
        return notes
    if outside:
        notes.append(
            f"{stream.name}: {counted(outside, 'row')} before the first or after the last row of {piece.ticks.name}, "
            "whose rows are the log's ticks, left out."
        )
    if len(rows) > len(later):
        lost = counted(len(rows) - len(later), "row")
        notes.append(f"{stream.name}: {lost} dropped: a later row has the same time step.")
    return notes


def _interpolated(ticks: np.ndarray, time: np.ndarray, stream: Stream) -> tuple[np.ndarray, np.ndarray]:
    """Linear interpolation between new measurements; no values beyond the ends or across a gap."""
    value = np.full((len(ticks), stream.value.shape[1]), np.nan)
    for i in range(value.shape[1]):
        rows = np.flatnonzero(stream.fresh[:, i])
        if len(rows) < 2:
            continue
        at = time[rows]
        value[:, i] = np.interp(ticks, at, stream.value[rows, i], left=np.nan, right=np.nan)
        step = np.diff(at)
        after = np.clip(np.searchsorted(at, ticks, side="left"), 1, len(at) - 1)
        value[(step[after - 1] > GAP * np.median(step)) & (ticks != at[after]) & (ticks != at[after - 1]), i] = np.nan
    return value, np.isfinite(value)
