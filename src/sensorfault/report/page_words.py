"""The sentences and tables of the report page, as HTML. Text from files is escaped here."""

from collections.abc import Iterable, Sequence
from datetime import UTC, datetime
from html import escape

from sensorfault.core.times import clock
from sensorfault.events.event import CLOCK, MOTION, UNKNOWN, WHOLE_LOG, Event
from sensorfault.faults.fault import SIZELESS, Fault
from sensorfault.report.page_sketch import Sketch

DROPOUTS_ONLY = "checked for dropouts only"


def number(value: float | None) -> str:
    """Three digits; a dash for None."""
    return "–" if value is None else f"{value:.3g}"


def _count(number: int, what: str) -> str:
    return f"{number or 'no'} {what}{'' if number == 1 else 's'}"


def headline(sketch: Sketch) -> str:
    """The finding in one sentence."""
    whom = [event.accused for event in sketch.events]
    named = {e.sensor for e in sketch.events if e.sensor is not None and e.subject == "sensor"}
    faults = sum(one not in (CLOCK, MOTION, WHOLE_LOG) for one in whom)
    text = _count(faults, "fault") + (f" on {_count(len(named), 'sensor')}" if named else "")
    if UNKNOWN in whom:
        text += f", {whom.count(UNKNOWN)} of them on an unknown sensor"
    if MOTION in whom:
        text += f", {_count(whom.count(MOTION), 'implausible motion')}"
    if CLOCK in whom:
        text += f", {_count(whom.count(CLOCK), 'jump')} of the clock"
    if WHOLE_LOG in whom:
        text += f", {_count(whom.count(WHOLE_LOG), 'gap')} in the log"
    unjudged = blind(sketch)
    text += f"; {_count(len(sketch.log.sensors) - len(unjudged), 'sensor')} watched"
    if unjudged:
        text += f", {', '.join(unjudged)} {DROPOUTS_ONLY}"
    return escape(text[0].upper() + text[1:] + ".")


def blind(sketch: Sketch) -> list[str]:
    """Sensors without a channel that is judged."""
    judged = {c.sensor for c, watched in zip(sketch.log.channels, sketch.watched, strict=True) if watched}
    return [sensor.name for sensor in sketch.log.sensors if sensor.name not in judged]


def facts(sketch: Sketch) -> str:
    """Duration, rate, size, start and method in one line."""
    log, rows = sketch.log, sketch.rows
    items = [f"duration {clock(sketch.end_s - sketch.start_s)}", f"{rows:,} sample{'' if rows == 1 else 's'}"]
    if rows > 1:
        items[-1] += f" at {1 / sketch.period_s:.3g} Hz"
    items += [_count(len(log.sensors), "sensor"), _count(len(log.channels), "channel")]
    if log.epoch_s is not None:
        items.append(f"from {datetime.fromtimestamp(log.epoch_s, UTC):%Y-%m-%d %H:%M:%S} UTC")
    return escape(" · ".join([*items, f"method {sketch.method}"]))


def sentences(heading: str, lines: Sequence[str]) -> str:
    """A list under a heading; nothing if it is empty."""
    if not lines:
        return ""
    return f"<h3>{escape(heading)}</h3><ul>{''.join(f'<li>{escape(line)}</li>' for line in lines)}</ul>"


def match(fault: Fault, events: Iterable[Event]) -> Event | None:
    """The event on the fault's sensor during the fault; of several, the one with the most in common.

    For display only: `evaluation.judge` measures how good a detection is.
    """
    same = [
        e
        for e in events
        if e.sensor == fault.sensor and e.start_s <= fault.end_s and (e.end_s is None or e.end_s >= fault.start_s)
    ]
    return max(same, key=lambda e: (e.channel == fault.channel) + (e.kind == fault.kind), default=None)


def found(fault: Fault, events: Iterable[Event]) -> bool:
    """Whether an event matches the fault."""
    return match(fault, events) is not None


def _outcome(fault: Fault, event: Event | None) -> str:
    """Whether an injected fault was found, and as what if that differs from the truth."""
    if event is None:
        return "missed"
    if (event.channel, event.kind) == (fault.channel, fault.kind):
        return "found"
    return f"found as {event.kind} of {event.channel or 'all'}"


def _row(start_s: float, end_s: float | None, log_end_s: float, cells: Sequence[str], tone: str = "") -> str:
    """A table row; a click on it zooms the plots to its time. `cells` are escaped here."""
    last = log_end_s if end_s is None else end_s
    times = [_time(start_s), "ongoing" if end_s is None else _time(end_s)]
    body = "".join(f'<td class="time">{cell}</td>' for cell in times) + "".join(f"<td>{escape(c)}</td>" for c in cells)
    return f'<tr tabindex="0" data-from="{start_s:.6f}" data-to="{last:.6f}" class="{tone}">{body}</tr>'


def _time(seconds: float) -> str:
    return f"{seconds:.2f} s <small>{clock(seconds)}</small>"


def _table(heads: Sequence[str], rows: Sequence[str]) -> str:
    head = "".join(f"<th>{escape(h)}</th>" for h in heads)
    return f'<div class="wide"><table><thead><tr>{head}</tr></thead><tbody>{"".join(rows)}</tbody></table></div>'


def event_table(sketch: Sketch) -> str:
    """All events, numbered as in the plots."""
    if not sketch.events:
        return '<p class="none">No fault was found.</p>'
    end = sketch.end_s
    rows = []
    for i, e in enumerate(sketch.events, 1):
        against = "–" if e.peak_score is None else f"{number(e.peak_score)} / {number(e.limit)}"
        against += " s silent" if e.kind == "missing" and e.peak_score is not None else ""
        row = _row(e.start_s, e.end_s, end, (e.accused, e.channel or "–", e.kind, against, e.found_by or e.method))
        rows.append(row.replace("<td", f"<td>{i}</td><td", 1))
    return _table(("", "start", "end", "sensor", "channel", "kind", "peak / limit", "found by"), rows)


def truth_table(sketch: Sketch, truth: Sequence[Fault]) -> str:
    """All injected faults, found or missed; nothing if none was injected."""
    if not truth:
        return ""
    end = sketch.end_s
    rows, hits = [], 0
    for fault in sorted(truth, key=lambda f: f.start_s):
        event = match(fault, sketch.events)
        hits += event is not None
        size = f"{fault.magnitude:.3g}{' σ' if fault.sigmas else ''}" if fault.kind not in SIZELESS else "–"
        cells = (fault.sensor, fault.channel or "all", fault.kind, size, _outcome(fault, event))
        rows.append(_row(fault.start_s, fault.end_s, end, cells, "missed" if event is None else "hit"))
    text = f"{hits} of {len(truth)} found. Any event on the same sensor that overlaps in time counts."
    heads = ("start", "end", "sensor", "channel", "kind", "magnitude", "")
    return f"<h2>Injected faults</h2><p>{text}</p>{_table(heads, rows)}"
