"""Limits of the tests: without a model from the log itself, held between a floor and a ceiling of its class."""

import tomllib
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import numpy as np
from jaxtyping import Float

from sensorfault.relations.axes import Mounting
from sensorfault.relations.change import ENDS_S
from sensorfault.relations.grid import STEP_S
from sensorfault.relations.tests_of import Piece, Test

SCALES = 13.0  # a limit is this many scales; ten let five of 24 healthy logs alarm, thirteen two (each left out)
# Constant differences of rates that are usual for such sensors, by the part of a relation: a calibration, no fault.
USUAL_RATE = {"gyro": 0.02, "side": 0.1, "acc": 0.6, "accelerometer": 0.6, "wheel": 1.5, "climb": 0.3, "reckoned": 0.3}
RATE_WINDOWS_S = (4.0, 15.0)
SPARE, MOST_FACTOR, SHARE = 2.0, 4.0, 0.25  # of limits from healthy driving: margin; largest factor; share of the floor
BLOCK_S, BLOCKS = 20.0, 5  # blocks of 20 s, or a fifth of the piece
CLASSES = ("copter", "wing", "car", "rail", "underwater")


@dataclass(frozen=True)
class Bounds:
    """The least and the largest scale of one kind of test in a class of vehicles."""

    floor: float
    ceiling: float


# A steering turns a car by a kinematic model, which real tyres do not follow, and no real log of turns has one. An
# airspeed differs from the speed over ground by the wind, which simulated flights lack.
LEAST = {"steering": Bounds(0.1, 0.2), "airspeed": Bounds(0.6, 1.2)}
ByTest = dict[str, tuple[Test, list[np.ndarray]]]  # each test, with its changes in the pieces


@dataclass
class Learned:
    """What is known of one vehicle: usual rate of each relation, limit of each test, lags, facts.

    `own`: whether it comes from other, healthy logs (a model), not from the log that is judged.
    """

    rates: dict[str, float] = field(default_factory=dict)
    limit: dict[str, float] = field(default_factory=dict)
    lags: dict[str, float] = field(default_factory=dict)
    facts: dict[str, float] = field(default_factory=dict)
    mountings: dict[str, Mounting] = field(default_factory=dict)
    vehicle: str = ""


@cache
def table() -> dict[str, dict[tuple[str, float], Bounds]]:
    """Bounds by class and kind of test, from the table beside this file."""
    with (Path(__file__).parent / "classes.toml").open("rb") as file:
        rows = tomllib.load(file)["change"]
    found: dict[str, dict[tuple[str, float], Bounds]] = {name: {} for name in CLASSES}
    for row in rows:
        found[row["class"]][row["kind"], float(row["window_s"])] = Bounds(row["floor"], row["ceiling"])
    return found


def bounds(vehicle: str, kind: tuple[str, float]) -> Bounds | None:
    """Those of a class; of an unknown class the widest of all; None if no class has any."""
    classes = (
        [table()[vehicle]] if kind in table().get(vehicle, {}) else [one for one in table().values() if kind in one]
    )
    least = next((LEAST[part] for part in kind[0].split("|") if part in LEAST), None)
    known = [one[kind] for one in classes] + ([least] if least else [])
    return Bounds(max(one.floor for one in known), max(one.ceiling for one in known)) if known else None


def block_maxima(moved: Float[np.ndarray, " T"]) -> Float[np.ndarray, " B"]:
    """The largest change of each block that has some."""
    size = max(round(min(BLOCK_S, len(moved) * STEP_S / BLOCKS) / STEP_S), 5)
    blocks = [np.abs(moved[i : i + size]) for i in range(0, len(moved), size)]
    return np.array([np.nanmax(block) for block in blocks if np.isfinite(block).sum() >= 3])


def of_healthy(pieces: list[Piece], vehicle: str, lags: dict[str, float], facts: dict[str, float]) -> Learned:
    """Limits from healthy driving: the largest change of each test times one factor for its family.

    The factor is by how much a block left out, with its neighbours, exceeds the largest change of all others. So one
    lively family does not widen the limits of the others.
    """
    by_test = _by_test(pieces)
    rates = _rates(by_test)
    learned = Learned(rates, lags=lags, facts=facts)
    blocks: dict[str, Float[np.ndarray, " B"]] = {}
    for key, (test, parts) in by_test.items():
        bias = rates.get(test.relation.name, 0.0) * span_s(test)
        maxima = np.concatenate([block_maxima(part - bias) for part in parts])
        if len(maxima):
            blocks[key] = maxima
    factors: dict[str, float] = {}
    for key, maxima in blocks.items():
        family = by_test[key][0].relation.family
        factors[family] = max(factors.get(family, 1.0), _left_out(maxima))
    for key, maxima in blocks.items():
        test = by_test[key][0]
        known = bounds(vehicle, test.kind)
        least = SHARE * SCALES * known.floor if known else 0.0
        most = SCALES * known.ceiling if known else np.inf
        scale = min(factors[test.relation.family], MOST_FACTOR) * SPARE * float(maxima.max())
        learned.limit[key] = float(np.clip(scale, least, max(most, SPARE * float(maxima.max()))))
    return learned


def _left_out(maxima: Float[np.ndarray, " B"]) -> float:
    """The largest block against the largest of those that share no window with it."""
    worst = int(np.argmax(maxima))
    others = np.delete(maxima, [i for i in (worst - 1, worst, worst + 1) if 0 <= i < len(maxima)])
    return float(maxima[worst] / max(others.max(), 1e-12)) if len(others) else MOST_FACTOR


def _by_test(pieces: list[Piece]) -> ByTest:
    """The changes of each test in all pieces where it has some."""
    found: ByTest = {}
    for piece in pieces:
        for k, test in enumerate(piece.tests):
            if np.isfinite(piece.moved[:, k]).any():
                found.setdefault(test.key, (test, []))[1].append(piece.moved[:, k])
    return found


def of_log(pieces: list[Piece], vehicle: str, lags: dict[str, float], facts: dict[str, float]) -> Learned:
    """Limits of a log from itself: its usual block maximum, times SCALES, within the bounds of its class."""
    by_test = _by_test(pieces)
    rates = _rates(by_test)
    learned = Learned(rates, lags=lags, facts=facts)
    for key, (test, parts) in by_test.items():
        known = bounds(vehicle, test.kind)
        bias = rates.get(test.relation.name, 0.0) * span_s(test)
        maxima = np.concatenate([block_maxima(part - bias) for part in parts])
        if not len(maxima):
            continue
        if known is None:
            continue  # what healthy logs of any class show is not known: without a fit this does not vote
        learned.limit[key] = SCALES * float(np.clip(np.median(maxima), known.floor, known.ceiling))
    return learned


def least_of(piece: Piece, vehicle: str) -> Float[np.ndarray, " K"]:
    """Below this no limit of a test lies, however quiet its past: a share of the floor of the class."""
    known = [bounds(vehicle, test.kind) for test in piece.tests]
    return np.array([SHARE * SCALES * one.floor if one else np.inf for one in known])


def span_s(test: Test) -> float:
    """From the middle of a window's first ticks to the middle of its last [s]; 0 for a change of slope."""
    return max(test.window_s - min(test.window_s / 4, ENDS_S), STEP_S) if test.relation.order == 1 else 0.0


def _rates(by_test: ByTest) -> dict[str, float]:
    """The usual rate at which the witnesses of each relation part: the median over windows of 4 or 15 s.

    Within what is usual for such sensors: a fault that fills the log must not pass for it.
    """
    found = {}
    for test, parts in by_test.values():
        moved = np.concatenate(parts)
        if test.window_s in RATE_WINDOWS_S and test.relation.order == 1 and np.isfinite(moved).sum() > 50:
            most = usual_rate(test)
            found[test.relation.name] = float(np.clip(np.nanmedian(moved) / span_s(test), -most, most))
    return found


def usual_rate(test: Test) -> float:
    """How fast two sensors may always part because they have another zero or scale."""
    return max((USUAL_RATE.get(part, 0.05) for part in test.relation.kind.split("|")), default=0.0)
