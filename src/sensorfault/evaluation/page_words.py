"""The words and tables of the report page, as HTML. Everything that comes from a file is escaped here."""

from collections.abc import Iterable, Sequence
from datetime import UTC, datetime
from html import escape

from sensorfault.detection import Detection
from sensorfault.events import Event
from sensorfault.faults.fault import Fault

MOTION, GAP, NAMELESS = "vehicle motion", "all (gap in the log)", "unknown which"  # where no sensor is named
SILENCE_ONLY = "only its silence is noticed"


def clock(seconds: float) -> str:
    """[s] -> m:ss.ss, from an hour on h:mm:ss.ss."""
    hundredths = round(abs(seconds) * 100)
    minutes, rest = divmod(hundredths, 6000)
    hours, minutes = divmod(minutes, 60)
    text = f"{hours}:{minutes:02d}:{rest / 100:05.2f}" if hours else f"{minutes}:{rest / 100:05.2f}"
    return f"−{text}" if seconds < 0 else text


def number(value: float | None) -> str:
    """Three digits, or a dash where there is nothing to say."""
    return "–" if value is None else f"{value:.3g}"


def _count(number: int, what: str) -> str:
    return f"{number or 'no'} {what}{'' if number == 1 else 's'}"


def result(detection: Detection) -> str:
    """The finding in one sentence."""
    kinds = [_accused(event) for event in detection.events]
    named = {e.sensor for e in detection.events if e.sensor is not None and e.subject == "sensor"}
    faults = sum(accused not in (MOTION, GAP) for accused in kinds)
    text = _count(faults, "fault") + (f" on {_count(len(named), 'sensor')}" if named else "")
    if NAMELESS in kinds:
        text += f", {kinds.count(NAMELESS)} of them not laid to one sensor"
    if MOTION in kinds:
        text += f", {_count(kinds.count(MOTION), 'implausible motion')}"
    if GAP in kinds:
        text += f", {_count(kinds.count(GAP), 'gap')} in the log"
    unjudged = blind(detection)
    text += f"; {_count(len(detection.log.sensors) - len(unjudged), 'sensor')} watched"
    if unjudged:
        silence = SILENCE_ONLY if len(unjudged) == 1 else SILENCE_ONLY.replace("its", "their")
        text += f", {', '.join(unjudged)} not judged ({silence})"
    return escape(text[0].upper() + text[1:] + ".")


def blind(detection: Detection) -> list[str]:
    """Sensors of which no channel is judged."""
    judged = {c.sensor for c, watched in zip(detection.log.channels, detection.watched, strict=True) if watched}
    return [sensor.name for sensor in detection.log.sensors if sensor.name not in judged]


def _accused(event: Event) -> str:
    if event.subject == "motion":
        return MOTION
    return event.sensor or (GAP if event.kind == "miss" else NAMELESS)


def facts(detection: Detection) -> str:
    """Duration, rate, size, start and method in one line."""
    log = detection.log
    items = [f"duration {clock(log.duration_s)}", f"{len(log):,} sample{'' if len(log) == 1 else 's'}"]
    if len(log) > 1:
        items[-1] += f" at {1 / log.period_s:.3g} Hz"
    items += [_count(len(log.sensors), "sensor"), _count(len(log.channels), "channel")]
    if log.epoch_s is not None:
        items.append(f"from {datetime.fromtimestamp(log.epoch_s, UTC):%Y-%m-%d %H:%M:%S} UTC")
    return escape(" · ".join([*items, f"method {detection.method}"]))


def sentences(heading: str, lines: Sequence[str]) -> str:
    """A short list under a heading, or nothing."""
    if not lines:
        return ""
    return f"<h3>{escape(heading)}</h3><ul>{''.join(f'<li>{escape(line)}</li>' for line in lines)}</ul>"


def match(fault: Fault, events: Iterable[Event]) -> Event | None:
    """The event that names the fault's sensor while the fault lasts; of several, the most alike.

    For display only; no measure of merit.
    """
    same = [
        e
        for e in events
        if e.sensor == fault.sensor and e.start_s <= fault.end_s and (e.end_s is None or e.end_s >= fault.start_s)
    ]
    return max(same, key=lambda e: (e.channel == fault.channel) + (e.kind == fault.kind), default=None)


def found(fault: Fault, events: Iterable[Event]) -> bool:
    """Whether there is such an event."""
    return match(fault, events) is not None


def _outcome(fault: Fault, event: Event | None) -> str:
    """What became of an injected fault; the event's own words where they differ from the truth."""
    if event is None:
        return "missed"
    if (event.channel, event.kind) == (fault.channel, fault.kind):
        return "found"
    return f"found as {event.kind} of {event.channel or 'all'}"


def _row(start_s: float, end_s: float | None, log_end_s: float, cells: Sequence[str], tone: str = "") -> str:
    """A row that zooms the plots to its time; `cells` are escaped here."""
    last = log_end_s if end_s is None else end_s
    times = [_time(start_s), "lasts" if end_s is None else _time(end_s)]
    body = "".join(f'<td class="time">{cell}</td>' for cell in times) + "".join(f"<td>{escape(c)}</td>" for c in cells)
    return f'<tr tabindex="0" data-from="{start_s:.6f}" data-to="{last:.6f}" class="{tone}">{body}</tr>'


def _time(seconds: float) -> str:
    return f"{seconds:.2f} s <small>{clock(seconds)}</small>"


def _table(heads: Sequence[str], rows: Sequence[str]) -> str:
    head = "".join(f"<th>{escape(h)}</th>" for h in heads)
    return f'<div class="wide"><table><thead><tr>{head}</tr></thead><tbody>{"".join(rows)}</tbody></table></div>'


def event_table(detection: Detection) -> str:
    """All events, numbered as in the plots."""
    if not detection.events:
        return '<p class="none">No fault was found.</p>'
    end = float(detection.log.time[-1])
    rows = []
    for i, e in enumerate(detection.events, 1):
        against = "–" if e.peak_score is None else f"{number(e.peak_score)} / {number(e.limit)}"
        against += " s silent" if e.kind == "miss" and e.peak_score is not None else ""
        row = _row(e.start_s, e.end_s, end, (_accused(e), e.channel or "–", e.kind, against, e.method))
        rows.append(row.replace("<td", f"<td>{i}</td><td", 1))
    return _table(("", "start", "end", "sensor", "channel", "kind", "peak / limit", "method"), rows)


def truth_table(detection: Detection, truth: Sequence[Fault]) -> str:
    """All injected faults, found or missed, or nothing where none was injected."""
    if not truth:
        return ""
    end = float(detection.log.time[-1])
    rows, hits = [], 0
    for fault in sorted(truth, key=lambda f: f.start_s):
        event = match(fault, detection.events)
        hits += event is not None
        size = f"{fault.magnitude:.3g}{' σ' if fault.sigmas else ''}" if fault.kind not in ("jam", "miss") else "–"
        cells = (fault.sensor, fault.channel or "all", fault.kind, size, _outcome(fault, event))
        rows.append(_row(fault.start_s, fault.end_s, end, cells, "missed" if event is None else "hit"))
    text = f"{hits} of {len(truth)} found, counting any event on the same sensor that overlaps."
    heads = ("start", "end", "sensor", "channel", "kind", "magnitude", "")
    return f"<h2>Injected faults</h2><p>{text}</p>{_table(heads, rows)}"
