"""A log that goes on: of later rows only what is new is compared."""

from dataclasses import replace
from typing import Any

import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import Log
from sensorfault.relations import axes, levels, past
from sensorfault.relations.grid import STEP_S, Grid, pieces_of
from sensorfault.relations.judge import Judged, impact, judge, scored
from sensorfault.relations.levels.finding import Finding
from sensorfault.relations.limits import Learned
from sensorfault.relations.signals import Signal, gone_on
from sensorfault.relations.tests_of import Pair, Piece, compared, paired
from sensorfault.relations.usual import Usual

KEPT_S = 80.0  # the longest window, and what comes before it
AGAIN_S = 60.0  # so often the last KEPT_S are judged as a whole: a sensor may have begun
RECENT_S, ALIGNED_S = 16.0, 2.0  # what is compared again is so long, and begins at a multiple of this
EDGE_S, NEW_S = 1.6, 3.0  # its first ticks lack what came before; the last ones lacked what came after
SLOWEST_S = 1.1  # a slower sensor says too little in that time
NAMES_KEPT = 100
LEAST = 4  # measurements of a sensor that takes part


class Running:
    """Judges a log that goes on as `judge` would judge its last KEPT_S to KEPT_S + AGAIN_S.

    Witnesses of what is new differ from those of the whole by a constant, since integrals begin somewhere else; twice
    integrated ones by a line. Both are known from the ticks that they share.
    """

    def __init__(self, learned: Learned) -> None:
        self._learned = learned
        self._whole_s = -np.inf
        self._impact_s = np.inf
        self._last: Judged | None = None
        self._raw: dict[str, Signal] = {}  # of the last KEPT_S, as mounted
        self._usual: Float[np.ndarray, "T K"] = np.zeros((0, 0))
        self._lasting: dict[str, Finding] = {}

    def __getstate__(self) -> dict[str, Any]:
        """Without what is only there to save time: a copy asks for the whole first."""
        return self.__dict__ | {"_last": None}

    def whole(self, log: Log) -> Judged:
        """Judge the last KEPT_S."""
        judged = judge(log, self._learned)
        self._whole_s = float(log.time[-1])
        self._impact_s, self._lasting = impact(judged.signals), {}
        sensors = {one.sensor for one in judged.signals.values()}
        lost = {key: one for key, one in self._raw.items() if one.sensor not in sensors}
        spans = [(piece.grid.start_s, piece.grid.end_s) for piece in judged.pieces[-1:]]
        judged.findings += levels.silences(lost, spans, judged.vehicle)
        judged.signals |= {key: one for key, one in lost.items() if key not in judged.signals}
        self._raw = judged.signals
        self._last = judged if _goes_on(judged, self._whole_s) else None
        if self._last:
            self._usual = Usual(self._learned.rates).changes(judged.pieces[-1])
        self._remember(judged)
        return judged

    def more(self, rows: Log) -> Judged | None:
        """Judge what follows. None if these rows alone do not show it: then give the whole."""
        last, end_s = self._last, float(rows.time[-1])
        if last is None or end_s - self._whole_s > AGAIN_S:
            return None
        later = axes.turned({key: gone_on(one, rows) for key, one in self._raw.items()}, last.mountings)
        self._raw = {key: _joined(one, later[key], end_s - KEPT_S) for key, one in self._raw.items()}
        old = last.pieces[-1].grid
        first = max(int((end_s - RECENT_S - old.start_s) // ALIGNED_S), 0) * round(ALIGNED_S / STEP_S)
        recent = self._recent(old, old.start_s + first * STEP_S, end_s)
        if len(pieces_of(recent.signals)) != 1:
            self._last = None
            return None
        keep = len(old.time) - round(NEW_S / STEP_S)
        piece = self._longer(last.pieces[-1], recent, first, keep)
        self._usual = Usual(self._learned.rates).changes(piece, self._usual[:keep])
        self._impact_s = min(self._impact_s, impact(recent.signals))
        names = last.names if len(last.names) < NAMES_KEPT else {}
        judged = Judged(last.vehicle, self._raw, last.mountings, [piece], last.learned, [], names=names)
        self._last = scored(judged, [self._usual], [self._found(old, recent, last.vehicle)], self._impact_s)
        self._remember(self._last)
        return self._last

    def _recent(self, old: Grid, start_s: float, end_s: float) -> Grid:
        """A grid of these seconds, without the sensors that fell silent."""
        cut = {key: self._raw[key].cut(start_s, end_s) for key in old.signals}
        return Grid({key: one for key, one in cut.items() if len(one.time) >= LEAST}, start_s, end_s, old.facts)

    def _longer(self, piece: Piece, recent: Grid, first: int, keep: int) -> Piece:
        """The piece with what is recent from tick `keep` on; `first`: the tick at which that begins."""
        old = piece.grid
        grid = Grid({key: self._raw[key] for key in old.signals}, old.start_s, recent.end_s, old.facts)
        for role in (role for role in past.STATES if role in grid):
            new = past.motion_of(recent, role) if role in recent else np.zeros(len(recent.time))
            moved = np.concatenate([past.motion_of(old, role)[:keep], new[keep - first :]])
            past.motion_of(grid, role, moved)
        return compared(grid, tuple(_grown(pair, recent, first, keep) for pair in piece.pairs), piece, keep)

    def _found(self, old: Grid, recent: Grid, vehicle: str) -> list[Finding]:
        """What the levels find, and the offsets that they found before."""
        minute = self._recent(old, max(old.start_s, recent.end_s - KEPT_S), recent.end_s)
        found = [*levels.soon(recent, vehicle), *levels.late(minute, vehicle)]
        named = {one.device for one in found if one.lasting}
        return found + [one for device, one in self._lasting.items() if device not in named]

    def _remember(self, judged: Judged) -> None:
        """Offsets of devices, which are left out until the piece ends."""
        self._lasting.update({one.device: one for one in judged.findings if one.lasting})


def _goes_on(judged: Judged, end_s: float) -> bool:
    """Whether later rows can be added: all windows are there, and no sensor is so slow that it needs more of them."""
    if not judged.pieces or judged.pieces[-1].grid.end_s < end_s - 1.0:
        return False
    grid = judged.pieces[-1].grid
    slow = any(not one.columns or one.period_s > SLOWEST_S for one in grid.signals.values())
    return grid.end_s - grid.start_s > KEPT_S - 1.0 and not slow


def _joined(old: Signal, later: Signal, start_s: float) -> Signal:
    """What was measured since a time, and at least a little."""
    kept = slice(min(int(np.searchsorted(old.time, start_s)), max(len(old.time) - LEAST, 0)), None)
    return replace(
        old,
        time=np.concatenate([old.time[kept], later.time]),
        value=np.concatenate([old.value[kept], later.value]),
    )


def _grown(pair: Pair, grid: Grid, first: int, keep: int) -> Pair:
    """The pair on the ticks of a grid that begins at tick `first`, with its own up to tick `keep`."""
    both = pair.relation.difference(grid)
    nothing = np.full(len(grid.time), np.nan)
    new = paired(pair.relation, pair.windows_s, pair.lag_s, *(both or (nothing, nothing)))
    apart, left, right = (
        _on(known, found, first, keep, pair.relation.order)
        for known, found in ((pair.apart, new.apart), (pair.left, new.left), (pair.right, new.right))
    )
    return replace(pair, apart=apart, left=left, right=right)


def _on(
    old: Float[np.ndarray, " n"], new: Float[np.ndarray, " m"], first: int, keep: int, order: int
) -> Float[np.ndarray, " T"]:
    """The new ticks after the old ones, shifted by what both say of the ticks that they share."""
    edge = first + round(EDGE_S / STEP_S)
    shift = old[edge:keep] - new[edge - first : keep - first]
    there = np.flatnonzero(np.isfinite(shift))
    by = shift[there[-1]] if len(there) else 0.0
    if order == 2 and len(there) > 1:
        # nothing is integrated over a hole: the lines before and after it have one slope, but are not one line
        run = max(np.split(there, np.flatnonzero(np.diff(there) > 1) + 1), key=len)
        slope = (shift[run[-1]] - shift[run[0]]) / max(run[-1] - run[0], 1)
        by = by + slope * np.arange(keep - edge - there[-1], first + len(new) - edge - there[-1])
    return np.concatenate([old[:keep], new[keep - first :] + by])
