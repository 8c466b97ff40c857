"""Judge a whole log: tests, limits, names, and events from them."""

from dataclasses import dataclass, field, replace

import numpy as np
from jaxtyping import Float

from sensorfault.logs.table import Log
from sensorfault.relations import axes, facts, levels, limits, past
from sensorfault.relations.grid import STEP_S, Grid, pieces_of
from sensorfault.relations.isolation import Isolation, Named
from sensorfault.relations.levels.finding import Finding, runs
from sensorfault.relations.signals import Signal, signals_of
from sensorfault.relations.tests_of import Piece, judged
from sensorfault.relations.usual import Usual
from sensorfault.relations.vehicle_class import class_named
from sensorfault.relations.witnesses import SLOW_FAST_S

SHORTEST_S = 8.0  # a shorter piece compares nothing
JOIN_S = 10.0  # alarms closer than this are one episode
LEAST_TICKS = 3  # alarms that an episode needs
SURE = 0.6  # share of the named ticks that one device needs
TURNED = {"acc", "compass"}  # what the attitude turns into the local frame
GO_WHERE_THEY_POINT = {"car", "rail", "wing"}
AGREES_S = 60.0  # so long an attitude that was wrong must agree before it turns vectors again
IMPACT = 100.0  # [m/s^2]: judging ends


@dataclass(frozen=True)
class Episode:
    """Something is wrong from start to end. `device`: who, or None; `candidates`: devices with their costs."""

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
    """All that was found in a log. `names`: who explains which scores, as far as that was asked."""

    vehicle: str
    signals: dict[str, Signal]
    mountings: dict[str, axes.Mounting]
    pieces: list[Piece]
    learned: limits.Learned
    scores: list[Float[np.ndarray, "T K"]]
    episodes: list[Episode] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)
    names: dict[bytes, Named] = field(default_factory=dict)


def _prepared(logs: list[Log], learned: limits.Learned | None, name: str) -> Judged:
    """Signals, mountings and tests of one log or several of one vehicle, with what is known of it or begins to be.

    `name`: the class of the vehicle as a user says it; empty: it is guessed.
    """
    known = learned or limits.Learned()
    facts_of, lags, mountings = dict(known.facts), dict(known.lags), dict(known.mountings)
    signals: dict[str, Signal] = {}
    pieces: list[Piece] = []
    vehicle = known.vehicle
    for log in logs:
        signals, mountings = axes.mounted(signals_of(log), mountings)
        vehicle = vehicle or class_named(name, signals)
        if vehicle != "copter":
            facts_of.setdefault("acceleration.period", SLOW_FAST_S)
        unknown = {role + number for number, m in mountings.items() if m.turn is None for role in axes.INERTIAL}
        unknown |= {"gyro" + number for number, m in mountings.items() if not m.yaw}
        facts_of["mounted"] = float(not any(m.why for m in mountings.values()))
        facts_of["forward"] = float(all(m.forward for m in mountings.values()))
        used = {key: signal for key, signal in signals.items() if key not in unknown}
        for start, end in pieces_of(signals):
            if end - start < SHORTEST_S:
                continue
            inside = {key: part for key, signal in used.items() if len((part := signal.cut(start, end)).time) >= 4}
            grid = Grid(inside, start, end, facts_of)
            if learned is None and "steering.gain" not in facts_of:
                facts_of.update(facts.learned(grid))
            pieces.append(judged(grid, vehicle in GO_WHERE_THEY_POINT, lags))
    begun = limits.Learned(lags=lags, facts=facts_of, mountings=mountings, vehicle=vehicle)
    return Judged(vehicle, signals, mountings, pieces, learned or begun, [])


def fitted(logs: list[Log], name: str = "") -> limits.Learned:
    """What healthy logs of one vehicle teach: usual changes, limits, lags, axes. `name`: its class, if it is known."""
    result = _prepared(logs, None, name)
    begun = result.learned
    for piece in result.pieces:
        for fact, value in levels.ranges.largest(piece.grid).items():
            begun.facts[fact] = max(value, begun.facts.get(fact, value))
    learned = limits.of_healthy(result.pieces, result.vehicle, begun.lags, begun.facts)
    return replace(learned, mountings=result.mountings, vehicle=result.vehicle)


def judge(log: Log, learned: limits.Learned | None = None, name: str = "") -> Judged:
    """Judge a log. Without `learned` its limits come from the log itself and from its class of vehicle, `name`."""
    result = _prepared([log], learned, name)
    pieces, vehicle = result.pieces, result.vehicle
    if learned is None:
        begun = result.learned
        own = limits.of_log(pieces, vehicle, begun.lags, begun.facts)
        result.learned = replace(own, mountings=result.mountings, vehicle=vehicle)
    found = [list(levels.findings(piece.grid, vehicle)) for piece in pieces]
    usual = Usual(learned.rates if learned else {})
    return scored(result, [usual.changes(piece) for piece in pieces], found)


def scored(
    result: Judged, usual: list[Float[np.ndarray, "_ _"]], by_level: list[list[Finding]], end_s: float = np.inf
) -> Judged:
    """Add scores, episodes and findings to prepared pieces.

    Args:
        result: pieces with their tests.
        usual: the usual changes of each piece.
        by_level: what the levels found in each piece.
        end_s: nothing later is judged, nor what follows an impact.
    """
    pieces, signals, vehicle = result.pieces, result.signals, result.vehicle
    end_s = min(end_s, impact(signals))
    for piece, changes, all_found in zip(pieces, usual, by_level, strict=True):
        score, limit = _scores(piece, result.learned, changes, vehicle)
        found = [one for one in all_found if one.start_s < end_s]
        _leave_out(piece, score, found)
        if np.isfinite(end_s):
            score[piece.grid.time > end_s] = np.nan
        result.scores.append(score)
        result.episodes += _episodes(piece, score, limit, result.names)
        result.findings += found
    result.findings += levels.silences(signals, [(p.grid.start_s, min(p.grid.end_s, end_s)) for p in pieces], vehicle)
    return result


def impact(signals: dict[str, Signal]) -> float:
    """When the vehicle hit something hard [s]; infinite if it did not."""
    hits = [s.time[np.linalg.norm(s.value, axis=1) > IMPACT] for s in signals.values() if s.role == "accelerometer"]
    hits = [hit[0] for hit in hits if len(hit)]
    return float(min(hits)) if hits else float("inf")


def _scores(
    piece: Piece, learned: limits.Learned, usual: Float[np.ndarray, "T K"], vehicle: str
) -> tuple[Float[np.ndarray, "T K"], Float[np.ndarray, "T K"]]:
    """Changes without their usual value, in units of their limits; and those limits."""
    fixed = np.array([learned.limit.get(test.key, np.inf) for test in piece.tests])
    moved = piece.moved - usual
    limit = past.limits(piece, moved, fixed, limits.least_of(piece, vehicle))
    limit[:, ~np.isfinite(fixed)] = np.inf
    return np.where(np.isfinite(limit), moved / limit, np.nan), limit


def _leave_out(piece: Piece, score: Float[np.ndarray, "T K"], found: list[Finding]) -> None:
    """Compare nothing with a device that is wrong by itself, until the piece ends: no other may pay for it."""
    time = piece.grid.time
    for one in found:
        if one.lasting:
            mine = [any(device == one.device for (device, _), _ in test.relation.blame) for test in piece.tests]
            score[np.ix_(time > one.start_s, np.array(mine, bool))] = np.nan


def _episodes(
    piece: Piece, score: Float[np.ndarray, "T K"], limit: Float[np.ndarray, "T K"], names: dict[bytes, Named]
) -> list[Episode]:
    if not piece.tests:
        return []
    by_attitude = np.array([("attitude", "") in dict(test.relation.blame) for test in piece.tests])
    turned = np.array([bool(TURNED & set(test.relation.kind.split("|"))) for test in piece.tests])
    alone = _over(np.where(by_attitude | turned, np.nan, score))
    lone = _attitude_alone(piece, np.where(by_attitude[None, :], score, np.nan)) & ~alone
    # A tilt that the gyro denies is no fault of what it turns, whoever of the two is wrong.
    denied = _over(score[:, [test.relation.kind == "tilt|gyro" for test in piece.tests]])
    votes = np.where(by_attitude, np.nan, score)
    votes[np.ix_(_distrusted(lone | denied, _over(score[:, turned])), turned)] = np.nan  # a wrong attitude turned these
    over = _over(votes)
    episodes = []
    for device, alarm in ((None, over), ("attitude", lone)):
        for first, last in runs(piece.grid.time, alarm, JOIN_S):
            ticks = first + np.flatnonzero(alarm[first : last + 1])
            if len(ticks) < LEAST_TICKS:
                continue
            few = _some(ticks)
            named = (
                Named(device, ()) if device else Isolation.known(names, piece.tests, limit[few].min(axis=0), votes[few])
            )
            if named.device is None and not device:
                named = _by_the_attitude(piece, score[ticks], named)
            episodes.append(_episode(piece, score if device else votes, limit, ticks, named))
    return episodes


def _over(score: Float[np.ndarray, "T K"]) -> np.ndarray:
    """Ticks at which some test is over its limit."""
    return np.asarray((np.abs(score) > 1).any(axis=1))


def _distrusted(alarm: np.ndarray, over: np.ndarray) -> np.ndarray:
    """Ticks from an alarm of the attitude until for a minute what it turns has agreed with all others."""
    found = np.zeros(len(alarm), bool)
    if not alarm.any():
        return found
    until = -1
    for i, (now, off) in enumerate(zip(alarm, over, strict=True)):
        if now or (off and i <= until):
            until = i + round(AGREES_S / STEP_S)
        found[i] = i <= until
    return found


def _some(ticks: np.ndarray, most: int = 60) -> np.ndarray:
    """At most so many of them, evenly."""
    return ticks[:: max(1, len(ticks) // most)]


def _by_the_attitude(piece: Piece, score: Float[np.ndarray, "n K"], named: Named) -> Named:
    """Of devices that explain the same, the one that alone contradicts the attitude, which is no witness else."""
    worst: dict[str, float] = {}
    for device, _ in named.candidates:
        mine = [
            k
            for k, test in enumerate(piece.tests)
            if {one for (one, _), _ in test.relation.blame} == {device, "attitude"} and test.relation.family == "yaw"
        ]
        if mine and np.isfinite(score[:, mine]).any():
            worst[device] = float(np.nanmax(np.abs(score[:, mine])))
    over = [device for device, most in worst.items() if most > 1]
    return Named(over[0], named.candidates) if len(over) == 1 and len(worst) > 1 else named


def _attitude_alone(piece: Piece, score: Float[np.ndarray, "T K"]) -> np.ndarray:
    """Ticks at which two others or more contradict the attitude."""
    partners: dict[str, np.ndarray] = {}
    over = np.abs(score) > 1
    for k, test in enumerate(piece.tests):
        other = next((device for (device, _), _ in test.relation.blame if device != "attitude"), "")
        partners[other] = partners.get(other, False) | over[:, k]
    return sum((p.astype(int) for p in partners.values()), np.zeros(len(piece.grid.time), int)) >= 2


def _episode(
    piece: Piece, score: Float[np.ndarray, "T K"], limit: Float[np.ndarray, "T K"], ticks: np.ndarray, named: Named
) -> Episode:
    time = piece.grid.time
    peak = np.nan_to_num(np.abs(score[ticks]))
    i, k = np.unravel_index(int(np.argmax(peak)), peak.shape)
    start_s, end_s, test = float(time[ticks[0]]), float(time[ticks[-1]]), piece.tests[int(k)]
    return Episode(
        start_s, end_s, named.device, named.candidates, test.key, float(peak[i, k]), float(limit[ticks[i], k])
    )
