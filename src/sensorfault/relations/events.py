"""Events from episodes and findings: one for each device and time; an unknown one takes a name known later."""

from dataclasses import dataclass, replace

from sensorfault.events.event import Event
from sensorfault.relations.judge import JOIN_S, Judged
from sensorfault.relations.signals import Signal

METHOD = "auto"
MOST_CANDIDATES = 3
SAME_TEST_S = 60.0  # the same device, off by the same comparison again within this: one event


@dataclass(frozen=True)
class _Item:
    """A stretch of time in which one device, or nobody known, is at fault."""

    device: str | None
    start_s: float
    end_s: float
    kind: str
    test: str
    score: float
    limit: float
    candidates: tuple[str, ...] = ()


def sensor_of(device: str, signals: dict[str, Signal]) -> str:
    """The log's name of a device."""
    return next((s.sensor for s in signals.values() if s.key.partition(".")[0] == device), device)


def events_of(judged: Judged, last_s: float) -> tuple[Event, ...]:
    """The events of a log that ends at `last_s`, by onset."""
    named = [
        _Item(one.device, one.start_s, one.end_s, one.kind, one.test, abs(one.value), one.limit)
        for one in judged.findings
    ]
    unknown: list[_Item] = []
    for one in judged.episodes:
        candidates = tuple(name for name, _ in one.candidates[:MOST_CANDIDATES])
        item = _Item(
            one.device, one.start_s, one.end_s, one.kind, one.test, one.score * one.limit, one.limit, candidates
        )
        (unknown if one.device is None else named).append(item)
    joined = _joined(named)
    joined += [item for item in _joined(unknown) if not any(_explains(other, item) for other in joined)]
    joined.sort(key=lambda item: item.start_s)
    return tuple(_event(item, judged.signals, last_s) for item in joined)


def _joined(items: list[_Item]) -> list[_Item]:
    """Those of one device that lie close together as one; its kind is the first that is known."""
    found: list[_Item] = []
    for item in sorted(items, key=lambda item: item.start_s):
        last = next((one for one in reversed(found) if _same(one, item)), None)
        if last is None or item.start_s > last.end_s + (SAME_TEST_S if item.test == last.test else JOIN_S):
            found.append(item)
            continue
        worse = max(last, item, key=lambda one: one.score / max(one.limit, 1e-12))
        kind = last.kind if last.kind != "unknown" else item.kind
        both = replace(worse, start_s=last.start_s, end_s=max(last.end_s, item.end_s), kind=kind)
        found[found.index(last)] = both
    return found


def _same(one: _Item, other: _Item) -> bool:
    """Whether two stretches accuse the same: one device, or the same candidates."""
    return one.device == other.device and set(one.candidates if not one.device else ()) == set(
        other.candidates if not other.device else ()
    )


def _explains(known: _Item, item: _Item) -> bool:
    """Whether an unknown device is the known one: among its candidates and at fault at that time."""
    near = known.start_s - JOIN_S <= item.end_s and item.start_s <= known.end_s + JOIN_S
    return near and known.device in item.candidates


def _event(item: _Item, signals: dict[str, Signal], last_s: float) -> Event:
    end_s = None if item.end_s >= last_s - 1.0 else item.end_s
    sensor = None if item.device is None else sensor_of(item.device, signals)
    candidates = () if sensor else tuple(dict.fromkeys(sensor_of(one, signals) for one in item.candidates))
    start_s = max(item.start_s, 0.0)
    return Event(
        start_s, end_s, "sensor", sensor, None, item.kind, item.score, item.limit, METHOD, item.test, candidates
    )
