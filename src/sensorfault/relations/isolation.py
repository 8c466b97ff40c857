"""Who is to blame: of the explanations "this device is wrong", the cheapest."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from sensorfault.relations.table import LASTING
from sensorfault.relations.tests_of import Test

DEAD = 0.4  # what is left below this share of its limit is no disagreement
MOST = 5.0  # a group of tests counts no more than this many limits
EXTRA = 0.15  # price of a further part of one device that must be wrong
EXTRA_RECEIVER = 0.06  # a receiver is often wrong as a whole
QUIET = 0.08  # price if what must be wrong shows nowhere else where it should
FAST_S = 8.0  # a change over a window up to this is fast
MORE, RATIO = 0.05, 1.6  # the next explanation must cost this much more for a name


@dataclass(frozen=True)
class Named:
    """The answer: `device`, or None if the candidates cannot be told apart; their costs, cheapest first."""

    device: str | None
    candidates: tuple[tuple[str, float], ...]


@dataclass(frozen=True)
class _Group:
    """Tests of one family over one window: one fault moves them together."""

    family: str
    window_s: float
    tests: Int[np.ndarray, " g"]


class Isolation:
    """Explains K tests by the devices that they compare. `limit`: of each test."""

    def __init__(self, tests: tuple[Test, ...], limit: Float[np.ndarray, " K"]) -> None:
        parts = sorted({part for test in tests for part, _ in test.relation.blame})
        self.devices = sorted({device for device, _ in parts})
        column = {part: i for i, part in enumerate(parts)}
        self._gain = np.zeros((len(tests), len(parts)))
        for k, test in enumerate(tests):
            for part, sign in test.relation.blame:
                self._gain[k, column[part]] = sign / limit[k]
        self._mine = {device: [column[part] for part in parts if part[0] == device] for device in self.devices}
        found: dict[tuple[str, float], list[int]] = {}
        for k, test in enumerate(tests):
            if np.isfinite(limit[k]):
                found.setdefault((test.relation.family, test.window_s), []).append(k)
        self._groups = [_Group(*key, np.array(group)) for key, group in found.items()]

    def name(self, scores: Float[np.ndarray, "n K"]) -> Named:
        """Name the device that explains n moments best. `scores`: changes in units of their limits, NaN untested."""
        costs = {device: float(self._costs(device, scores).mean()) for device in self.devices}
        order = sorted(costs.items(), key=lambda item: item[1])
        if not order:
            return Named(None, ())
        best = order[0]
        rivals = [one for one in order[1:] if one[1] + MORE < RATIO * (best[1] + MORE)]
        return Named(None if rivals else best[0], (best, *rivals))

    def _costs(self, device: str, scores: Float[np.ndarray, "n K"]) -> Float[np.ndarray, " n"]:
        """What the device's shifts, fitted by least squares in each family and window, leave unexplained."""
        mine = self._mine[device]
        total = np.zeros(len(scores))
        used = np.zeros((len(scores), len(mine)), bool)
        shown: dict[str, Float[np.ndarray, "n p"]] = {}
        fast = np.zeros((len(scores), len(mine)))
        for group in self._groups:
            z = scores[:, group.tests]
            gain = self._gain[group.tests][:, mine]
            seen = np.stack(
                [np.nan_to_num(np.abs(z[:, gain[:, p] != 0])).max(axis=1, initial=0.0) for p in range(len(mine))], 1
            )
            tested = np.stack([np.isfinite(z[:, gain[:, p] != 0]).any(axis=1) for p in range(len(mine))], axis=1)
            seen = np.where(tested, seen, np.nan)
            shown[group.family] = np.fmax(shown[group.family], seen) if group.family in shown else seen
            fast = np.fmax(fast, seen) if group.window_s <= FAST_S else fast
            left, large = _left(z, gain)
            used |= large
            total += (np.maximum(np.abs(left) - DEAD, 0.0) ** 2).sum(axis=1)
        further = EXTRA_RECEIVER if device.startswith("gnss") else EXTRA
        total += further * np.maximum(used.sum(axis=1) - 1, 0)
        return np.asarray(total + QUIET * _quiet(shown, fast))


def _left(
    z: Float[np.ndarray, "n g"], gain: Float[np.ndarray, "g p"]
) -> tuple[Float[np.ndarray, "n g"], Bool[np.ndarray, "n p"]]:
    """What is left of a group's scores after the best shifts, and which parts had to be wrong; 0 where untested."""
    there = np.isfinite(z)
    size = np.nan_to_num(np.abs(z)).max(axis=1, initial=0.0)
    z = np.nan_to_num(z) * np.minimum(1.0, MOST / np.maximum(size, 1e-12))[:, None]
    large = np.zeros((len(z), gain.shape[1]), bool)
    patterns, which = np.unique(there, axis=0, return_inverse=True)
    for i, pattern in enumerate(patterns):
        rows = np.flatnonzero((which.ravel() == i) & (size > DEAD))
        parts = np.flatnonzero(np.abs(gain[pattern]).sum(axis=0)) if pattern.any() else np.zeros(0, int)
        if not len(rows) or not len(parts):
            continue
        own = gain[np.ix_(pattern, parts)]
        shift = z[np.ix_(rows, pattern)] @ np.linalg.pinv(own).T
        z[np.ix_(rows, pattern)] -= shift @ own.T
        large[np.ix_(rows, parts)] = np.abs(shift[:, None, :] * own[None]).max(axis=1) > DEAD
    return z, large


def _quiet(shown: dict[str, Float[np.ndarray, "n p"]], fast: Float[np.ndarray, "n p"]) -> Bool[np.ndarray, " n"]:
    """Moments at which a part that is over its limit is not to be seen at all in a family of tests that shows it.

    `shown`: its largest score in each family; `fast`: in any over a short window.
    """
    lasting = [most for family, most in shown.items() if family in LASTING]
    most = np.fmax.reduce(list(shown.values()))
    over = (most > 1) & (np.fmin.reduce(lasting) < DEAD) if lasting else np.zeros(most.shape, bool)
    over |= (fast > 1) & (np.fmin.reduce(list(shown.values())) < DEAD)
    return np.asarray(over.any(axis=1))
