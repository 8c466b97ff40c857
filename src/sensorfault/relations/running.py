"""A log that goes on: of later rows only what is new is compared."""

from dataclasses import replace

import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import Log
from sensorfault.relations import axes, levels, past
from sensorfault.relations.grid import STEP_S, Grid, pieces_of
from sensorfault.relations.judge import Judged, impact, judge, scored
from sensorfault.relations.levels.finding import Finding
from sensorfault.relations.limits import Learned
from sensorfault.relations.signals import Signal, gone_on
from sensorfault.relations.tests_of import Pair, compared, paired
from sensorfault.relations.usual import Usual

KEPT_S = 80.0  # the longest window, and what comes before it
AGAIN_S = 60.0  # so often the last KEPT_S are judged as a whole: a sensor may have begun
RECENT_S, ALIGNED_S = 16.0, 2.0  # what is compared again is so long, and begins at a multiple of this
EDGE_S, NEW_S = 1.6, 3.0  # its first ticks lack what came before; the last ones lacked what came after
SLOWEST_S = 1.1  # a slower sensor says too little in that time
NAMES_KEPT = 100


class Running:
    """Judges a log that goes on as `judge` would judge its last KEPT_S to KEPT_S + AGAIN_S.

    Witnesses of what is new differ from those of the whole by a constant, since integrals begin somewhere else; twice
    integrated ones by a line. Both are known from the ticks that they share.
    """

    def __init__(self, learned: Learned) -> None:
        self._learned = learned
        self._whole_s = self._end_s = -np.inf
        self._impact_s = np.inf
        self._last: Judged | None = None
        self._raw: dict[str, Signal] = {}  # of the last KEPT_S, as mounted
        self._usual: Float[np.ndarray, "T K"] = np.zeros((0, 0))
        self._lasting: dict[str, Finding] = {}

    def whole(self, log: Log) -> Judged:
        """Judge the last KEPT_S."""
        judged = judge(log, self._learned)
        self._whole_s = self._end_s = float(log.time[-1])
        self._impact_s = impact(judged.signals)
        self._lasting = {}
        self._raw = judged.signals
        self._last = judged if _goes_on(judged, self._end_s) else None
        self._usual = Usual(self._learned.rates).changes(judged.pieces[-1]) if self._last else np.zeros((0, 0))
        self._remember(judged)
        return judged

    def more(self, rows: Log) -> Judged | None:
        """Judge what follows. None if that cannot be told from these rows alone: then give the whole."""
        last, end_s = self._last, float(rows.time[-1])
        if last is None or end_s - self._whole_s > AGAIN_S:
            return None
        later = axes.turned({key: gone_on(one, rows) for key, one in self._raw.items()}, last.mountings)
        self._raw = {key: _joined(one, later[key], end_s - KEPT_S) for key, one in self._raw.items()}
        self._end_s = end_s
        piece = last.pieces[-1]
        old = piece.grid
        first = max(int((end_s - RECENT_S - old.start_s) // ALIGNED_S), 0) * round(ALIGNED_S / STEP_S)
        grid = Grid(self._cut(old, old.start_s + first * STEP_S, end_s), old.start_s + first * STEP_S, end_s, old.facts)
        if len(pieces_of(grid.signals)) != 1:
            self._last = None
            return None
        keep = len(old.time) - round(NEW_S / STEP_S)
        pairs = tuple(_grown(pair, grid, first, keep) for pair in piece.pairs)
        going = Grid(grid.signals, old.start_s, end_s, old.facts)
        for role in (role for role in past.STATES if role in grid):
            known, new = past.motion_of(old, role), past.motion_of(grid, role)
            going.keep(f"motion {role}", lambda known=known, new=new: np.r_[known[:keep], new[keep - first :]])
        found = [*levels.soon(grid, last.vehicle), *self._late(old, end_s, last.vehicle)]
        named = {one.device for one in found if one.lasting}
        found += [one for device, one in self._lasting.items() if device not in named]
        self._impact_s = min(self._impact_s, impact(grid.signals))
        piece = compared(going, pairs)
        self._usual = Usual(self._learned.rates).changes(piece, self._usual[:keep])
        judged = Judged(last.vehicle, self._raw, last.mountings, [piece], last.learned, [])
        judged.names = last.names if len(last.names) < NAMES_KEPT else {}
        self._last = scored(judged, [self._usual], [found], self._impact_s)
        self._remember(self._last)
        return self._last

    def _cut(self, old: Grid, start_s: float, end_s: float) -> dict[str, Signal]:
        """The signals of the piece in the last seconds, without those that fell silent."""
        cut = {key: self._raw[key].cut(start_s, end_s) for key in old.signals}
        return {key: one for key, one in cut.items() if len(one.time) >= 4}

    def _late(self, old: Grid, end_s: float, vehicle: str) -> list[Finding]:
        start_s = max(old.start_s, end_s - KEPT_S)
        return list(levels.late(Grid(self._cut(old, start_s, end_s), start_s, end_s, old.facts), vehicle))

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
    """What was measured since a time."""
    kept = slice(int(np.searchsorted(old.time, start_s)), None)
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
    parts = {name: _on(getattr(pair, name), getattr(new, name), first, keep, pair.relation.order) for name in NAMES}
    return replace(pair, **parts)


NAMES = ("apart", "left", "right")


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
