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
    """The answer: `device`, or None if several explain it alike; their costs, cheapest first."""

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

    @classmethod
    def known(
        cls,
        names: dict[bytes, Named],
        tests: tuple[Test, ...],
        limit: Float[np.ndarray, " K"],
        scores: Float[np.ndarray, "n K"],
    ) -> Named:
        """The name that these scores were given before, else the one that they get now."""
        key = limit.tobytes() + scores.tobytes()
        if key not in names:
            names[key] = cls(tests, limit).name(scores)
        return names[key]

    def name(self, scores: Float[np.ndarray, "n K"]) -> Named:
        """Name the device that explains n moments best. `scores`: changes in units of their limits, NaN untested."""
        groups = [_seen(group, scores) for group in self._groups]
        costs = {device: float(self._costs(device, groups).mean()) for device in self.devices if groups}
        order = sorted(costs.items(), key=lambda item: item[1])
        if not order:
            return Named(None, ())
        best = order[0]
        rivals = [one for one in order[1:] if one[1] + MORE < RATIO * (best[1] + MORE)]
        return Named(None if rivals else best[0], (best, *rivals))

    def _costs(self, device: str, groups: list["_Seen"]) -> Float[np.ndarray, " n"]:
        """What the device's shifts, fitted by least squares in each family and window, leave unexplained."""
        mine = self._mine[device]
        moments = len(groups[0].plain) if groups else 0
        total = np.zeros(moments)
        used = np.zeros((moments, len(mine)), bool)
        shown: dict[str, Float[np.ndarray, "n p"]] = {}
        fast = np.zeros((moments, len(mine)))
        for group in groups:
            gain = self._gain[group.tests][:, mine]
            if not gain.any():
                total += group.plain
                continue
            seen = np.stack([np.fmax.reduce(group.size[:, own != 0], axis=1, initial=np.nan) for own in gain.T], axis=1)
            shown[group.family] = np.fmax(shown[group.family], seen) if group.family in shown else seen
            fast = np.fmax(fast, seen) if group.window_s <= FAST_S else fast
            left, large = _left(group, gain)
            used |= large
            total += _cost(left)
        further = EXTRA_RECEIVER if device.startswith("gnss") else EXTRA
        total += further * np.maximum(used.sum(axis=1) - 1, 0)
        return np.asarray(total + QUIET * _quiet(shown, fast)) if shown else total


@dataclass(frozen=True)
class _Seen(_Group):
    """A group at n moments.

    `size`: its scores without their sign, NaN untested. `z`: its scores, none counted too much, 0 untested. `large`:
    which of its tests there were, and the moments with the same ones at which some test is not near zero. `plain`: what
    it costs unexplained.
    """

    size: Float[np.ndarray, "n g"]
    z: Float[np.ndarray, "n g"]
    large: list[tuple[Bool[np.ndarray, " g"], Int[np.ndarray, " _"]]]
    plain: Float[np.ndarray, " n"]


def _seen(group: _Group, scores: Float[np.ndarray, "n K"]) -> _Seen:
    z = scores[:, group.tests]
    there, size = np.isfinite(z), np.abs(z)
    most = np.nan_to_num(size).max(axis=1, initial=0.0)
    z = np.nan_to_num(z) * np.minimum(1.0, MOST / np.maximum(most, 1e-12))[:, None]
    over = np.flatnonzero(most > DEAD)
    patterns, which = np.unique(there[over], axis=0, return_inverse=True)
    large = [(pattern, over[which.ravel() == i]) for i, pattern in enumerate(patterns)]
    return _Seen(group.family, group.window_s, group.tests, size, z, large, _cost(z))


def _cost(left: Float[np.ndarray, "n g"]) -> Float[np.ndarray, " n"]:
    return np.asarray((np.maximum(np.abs(left) - DEAD, 0.0) ** 2).sum(axis=1))


def _left(group: _Seen, gain: Float[np.ndarray, "g p"]) -> tuple[Float[np.ndarray, "n g"], Bool[np.ndarray, "n p"]]:
    """What is left of a group's scores after the best shifts, and which parts had to be wrong; 0 where untested."""
    z = group.z.copy()
    large = np.zeros((len(z), gain.shape[1]), bool)
    for pattern, rows in group.large:
        parts = np.flatnonzero(np.abs(gain[pattern]).sum(axis=0))
        if not len(parts):
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
