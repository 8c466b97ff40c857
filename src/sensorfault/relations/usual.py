"""How fast two healthy witnesses part all the time, as far as a log has shown it: the zero and scale of each sensor."""

import numpy as np
from jaxtyping import Float

from sensorfault.relations.grid import STEP_S
from sensorfault.relations.limits import BLOCK_S, RATE_WINDOWS_S, span_s, usual_rate
from sensorfault.relations.tests_of import Piece

SIZE = round(BLOCK_S / STEP_S)  # ticks of a block
FIRST_BLOCKS = 2  # what these show holds for them, too
NEAR = 0.5  # of the usual rates: how far those of a drive may lie from those of the fit
EVERY = 5  # a median of every fifth tick is as good


class Usual:
    """The usual change of each test at each tick, from what came before; pieces of one log in their order.

    Args:
        known: the usual rate of each relation in the drives that the limits come from; none without a fit.
    """

    def __init__(self, known: dict[str, float]) -> None:
        self._known = known
        self._seen: dict[str, list[Float[np.ndarray, " n"]]] = {}

    def changes(self, piece: Piece, known: Float[np.ndarray, "t K"] | None = None) -> Float[np.ndarray, "T K"]:
        """Those of the next piece; a fault that begins later changes none of them.

        `known`: those of its first ticks, which came before; only what follows their last full block is found anew.
        """
        rates = {}
        done = 0 if known is None else len(known) // SIZE * SIZE
        for name in dict.fromkeys(test.relation.name for test in piece.tests):
            mine = [k for k, test in enumerate(piece.tests) if test.relation.name == name]
            shown = [
                k for k in mine if piece.tests[k].window_s in RATE_WINDOWS_S and piece.tests[k].relation.order == 1
            ]
            if shown:
                rate = np.stack([piece.moved[:, k] / span_s(piece.tests[k]) for k in shown], axis=1)
                rates[name] = self._rates(name, rate, usual_rate(piece.tests[shown[0]]), done)
        none = np.zeros(len(piece.grid.time) - done)
        columns = [rates.get(test.relation.name, none) * span_s(test) for test in piece.tests]
        later = np.reshape(columns, (len(columns), len(none))).T
        return later if known is None else np.concatenate([known[:done], later])

    def _rates(self, name: str, rate: Float[np.ndarray, "T m"], most: float, done: int) -> Float[np.ndarray, " t"]:
        """The usual rate at each tick: the median of all before its block, within what is usual for such sensors.

        `done`: ticks that are not asked for.
        """
        seen = self._seen.setdefault(name, [])
        first = FIRST_BLOCKS * SIZE if not seen else 0
        found = np.empty(len(rate) - done)
        for start in range(done, len(rate), SIZE):
            before = [*seen, rate[: max(start, first) : EVERY].ravel()]
            found[start - done : start - done + SIZE] = self._usual(name, np.concatenate(before), most)
        seen.append(rate[::EVERY].ravel())
        return found

    def _usual(self, name: str, seen: Float[np.ndarray, " n"], most: float) -> float:
        seen = seen[np.isfinite(seen)]
        shown = float(np.median(seen)) if len(seen) > 50 / EVERY else self._known.get(name, 0.0)
        if name in self._known:
            shown = self._known[name] + float(np.clip(shown - self._known[name], -NEAR * most, NEAR * most))
        return float(np.clip(shown, -most, most))
