"""Judge a whole log: tests, limits, names, and events from them."""

from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import Log
from sensorfault.relations import axes, facts, levels, limits
from sensorfault.relations.grid import STEP_S, Grid, pieces_of
from sensorfault.relations.isolation import Isolation, Named
from sensorfault.relations.levels import Finding
from sensorfault.relations.signals import Signal, signals_of
from sensorfault.relations.tests_of import Piece, judged
from sensorfault.relations.vehicle_class import class_of
from sensorfault.relations.witnesses import SLOW_FAST_S

SHORTEST_S = 8.0  # a shorter piece compares nothing
JOIN_S = 10.0  # alarms closer than this are one episode
LEAST_TICKS = 3  # alarms that an episode needs
SURE = 0.6  # share of the named ticks that one device needs
IMPACT = 100.0  # [m/s^2]: judging ends


@dataclass(frozen=True)
class Episode:
    """Something is wrong from start to end. `device`: who, or None; `candidates`: devices with their shares of blame."""

    start_s: float
    end_s: float
    device: str | None
    candidates: tuple[tuple[str, float], ...]
    test: str
    score: float
    limit: float
    kind: str = "unknown"


@dataclass
class Judged:
    """All that was found in a log."""

    vehicle: str
    signals: dict[str, Signal]
    mountings: dict[str, axes.Mounting]
    pieces: list[Piece]
    learned: limits.Learned
    scores: list[Float[np.ndarray, "T K"]]
    episodes: list[Episode] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)


def prepared(log: Log, learned: limits.Learned | None = None) -> tuple[str, dict[str, Signal], dict[str, axes.Mounting], list[Piece], limits.Learned]:
    """Signals, mountings and tests of a log, and what was learned of its vehicle (or is learned from it)."""
    signals, mountings = axes.mounted(signals_of(log))
    unknown = {role + number for number, m in mountings.items() if m.turn is None for role in axes.INERTIAL}
    vehicle = class_of(signals)
    used = {key: signal for key, signal in signals.items() if key not in unknown}
    facts_of = dict(learned.facts) if learned else {}
    lags = dict(learned.lags) if learned else {}
    if vehicle != "copter":
        facts_of.setdefault("acceleration.period", SLOW_FAST_S)
    pieces = []
    for start, end in pieces_of(used):
        if end - start < SHORTEST_S:
            continue
        inside = {key: part for key, signal in used.items() if len((part := signal.cut(start, end)).time) >= 4}
        grid = Grid(inside, start, end, facts_of)
        if learned is None and "steering.gain" not in facts_of:
            facts_of.update(facts.learned(grid))
        pieces.append(judged(grid, vehicle in ("car", "wing"), lags))
    learned = learned or limits.of_log(pieces, vehicle, lags, facts_of)
    return vehicle, signals, mountings, pieces, learned


def judge(log: Log, learned: limits.Learned | None = None) -> Judged:
    """Judge a log. Without `learned` its limits come from the log itself and from its class of vehicle."""
    vehicle, signals, mountings, pieces, learned = prepared(log, learned)
    result = Judged(vehicle, signals, mountings, pieces, learned, [])
    end_s = _impact(signals)
    for piece in pieces:
        score, limit = _scores(piece, learned)
        if np.isfinite(end_s):
            score[piece.grid.time > end_s] = np.nan
        result.scores.append(score)
        result.episodes += _episodes(piece, score, limit)
        result.findings += [one for one in levels.findings(piece.grid, vehicle) if one.start_s < end_s]
    result.findings += levels.silences(signals, [(p.grid.start_s, min(p.grid.end_s, end_s)) for p in pieces], vehicle)
    return result


def _impact(signals: dict[str, Signal]) -> float:
    """When the vehicle hit something hard [s]; infinite if it did not."""
    hits = [s.time[np.linalg.norm(s.value, axis=1) > IMPACT] for s in signals.values() if s.role == "accelerometer"]
    hits = [hit[0] for hit in hits if len(hit)]
    return float(min(hits)) if hits else float("inf")


def _scores(piece: Piece, learned: limits.Learned) -> tuple[Float[np.ndarray, "T K"], Float[np.ndarray, " K"]]:
    """Changes without their usual value, in units of their limits."""
    limit = np.array([learned.limit.get(test.key, np.inf) for test in piece.tests])
    bias = np.array([learned.bias.get(test.key, 0.0) for test in piece.tests])
    score = (piece.moved - bias) / limit
    score[:, ~np.isfinite(limit)] = np.nan
    return score, limit


def _episodes(piece: Piece, score: Float[np.ndarray, "T K"], limit: Float[np.ndarray, " K"]) -> list[Episode]:
    if not piece.tests:
        return []
    by_attitude = np.array([("attitude", "") in dict(test.relation.blame) for test in piece.tests])
    isolation = Isolation(piece.tests)
    votes = np.where(by_attitude, np.nan, score)
    over = np.nan_to_num(np.abs(votes)).max(axis=1) > 1
    lone = _attitude_alone(piece, np.where(by_attitude[None, :], score, np.nan)) & ~over
    episodes = []
    for device, alarm in ((None, over), ("attitude", lone)):
        for first, last in levels._runs(piece.grid.time, alarm, JOIN_S):
            ticks = first + np.flatnonzero(alarm[first : last + 1])
            if len(ticks) < LEAST_TICKS:
                continue
            named = Named(device, ()) if device else isolation.name(votes[_some(ticks)], limit)
            episodes.append(_episode(piece, score if device else votes, limit, ticks, named))
    return episodes


def _some(ticks: np.ndarray, most: int = 60) -> np.ndarray:
    """At most so many of them, evenly."""
    return ticks[:: max(1, len(ticks) // most)]


def _attitude_alone(piece: Piece, score: Float[np.ndarray, "T K"]) -> np.ndarray:
    """Ticks at which two others or more contradict the attitude."""
    partners: dict[str, np.ndarray] = {}
    for k, test in enumerate(piece.tests):
        other = next((device for (device, _), _ in test.relation.blame if device != "attitude"), "")
        now = np.nan_to_num(np.abs(score[:, k])) > 1
        partners[other] = partners.get(other, np.zeros(len(now), bool)) | now
    return sum((p.astype(int) for p in partners.values()), np.zeros(len(piece.grid.time), int)) >= 2


def _episode(
    piece: Piece, score: Float[np.ndarray, "T K"], limit: Float[np.ndarray, " K"], ticks: np.ndarray, named: Named
) -> Episode:
    time = piece.grid.time
    peak = np.nan_to_num(np.abs(score[ticks]))
    i, k = np.unravel_index(int(np.argmax(peak)), peak.shape)
    start_s, end_s, test = float(time[ticks[0]]), float(time[ticks[-1]]), piece.tests[int(k)]
    return Episode(start_s, end_s, named.device, named.candidates, test.key, float(peak[i, k]), float(limit[k]))
