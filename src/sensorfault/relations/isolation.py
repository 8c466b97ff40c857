"""Who is to blame: of the explanations "this device is wrong", the cheapest."""

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from sensorfault.relations.tests_of import Test

DEAD = 0.4  # what is left below this share of its limit is no disagreement
MOST = 5.0  # a group of tests counts no more than this many limits
EXTRA = 0.15  # price of a further part of one device that must be wrong
EXTRA_RECEIVER = 0.02  # a receiver is often wrong as a whole
MORE, RATIO = 0.05, 1.6  # the next explanation must cost this much more for a name
QUIET = 0.08  # price if what must be wrong shows nowhere else where it should


@dataclass(frozen=True)
class Named:
    """The answer at one time: `device`, or None if the candidates cannot be told apart; their costs, cheapest first."""

    device: str | None
    candidates: tuple[tuple[str, float], ...]


class Isolation:
    """Explains K tests by the devices that they compare."""

    def __init__(self, tests: tuple[Test, ...]) -> None:
        self.tests = tests
        parts = sorted({part for test in tests for part, _ in test.relation.blame})
        self.devices = sorted({device for device, _ in parts})
        column = {part: i for i, part in enumerate(parts)}
        self._gain = np.zeros((len(tests), len(parts)))
        for k, test in enumerate(tests):
            for part, sign in test.relation.blame:
                self._gain[k, column[part]] = sign
        self._mine = {device: [column[part] for part in parts if part[0] == device] for device in self.devices}
        self._family = [test.relation.family for test in tests]
        groups: dict[tuple[str, float], list[int]] = {}
        for k, test in enumerate(tests):
            groups.setdefault((test.relation.family, test.window_s), []).append(k)
        self._groups = [np.array(group) for group in groups.values()]

    def name(self, scores: Float[np.ndarray, "n K"], limit: Float[np.ndarray, " K"]) -> Named:
        """Name the device that explains n moments best. `scores`: changes in units of their limits, NaN untested."""
        costs = dict.fromkeys(self.devices, 0.0)
        for score in scores:
            there = np.isfinite(score)
            for device in self.devices:
                costs[device] += self._cost(device, np.where(there, score, 0.0), limit, there) / len(scores)
        order = sorted(costs.items(), key=lambda item: item[1])
        if not order:
            return Named(None, ())
        best = order[0]
        rivals = [one for one in order[1:] if one[1] + MORE < RATIO * (best[1] + MORE)]
        return Named(None if rivals else best[0], (best, *rivals))

    def _cost(
        self,
        device: str,
        z: Float[np.ndarray, " K"],
        limit: Float[np.ndarray, " K"],
        there: Bool[np.ndarray, " K"],
    ) -> float:
        """What the device's shifts, fitted by least squares in each family and window, leave unexplained."""
        mine = self._mine[device]
        total, used = 0.0, set()
        shown: dict[int, list[tuple[str, float]]] = {}
        for group in self._groups:
            group = group[there[group]]
            if not len(group):
                continue
            left = z[group]
            most = float(np.abs(left).max())
            for part in np.flatnonzero(np.abs(self._gain[np.ix_(group, mine)]).sum(axis=0)):
                seen = np.abs(left[self._gain[group, mine[part]] != 0]).max()
                shown.setdefault(mine[part], []).append((self._family[group[0]], float(seen)))
            left = left * min(1.0, MOST / max(most, 1e-12))
            if most > DEAD:
                gain = self._gain[np.ix_(group, mine)] / limit[group, None]
                parts = np.flatnonzero(np.abs(gain).sum(axis=0))
                if len(parts):
                    shift = np.linalg.lstsq(gain[:, parts], left, rcond=None)[0]
                    explained = gain[:, parts] * shift
                    used |= {mine[p] for p, e in zip(parts, np.abs(explained).max(axis=0), strict=True) if e > DEAD}
                    left = left - explained.sum(axis=1)
            total += float((np.maximum(np.abs(left) - DEAD, 0.0) ** 2).sum())
        further = EXTRA_RECEIVER if device.startswith("gnss") else EXTRA
        return total + further * max(len(used) - 1, 0) + (QUIET if _quiet(shown) else 0.0)


def _quiet(shown: dict[int, list[tuple[str, float]]]) -> bool:
    """Whether a part that is over its limit in one family of tests is not to be seen at all in another."""
    for tests in shown.values():
        by_family: dict[str, float] = {}
        for family, size in tests:
            by_family[family] = max(by_family.get(family, 0.0), size)
        if max(by_family.values()) > 1 and min(by_family.values()) < DEAD:
            return True
    return False
