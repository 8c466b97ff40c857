"""Sentences about a model: what it watches, what it leaves out, and what is known of its false alarms."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from sensorfault.core.times import clock

if TYPE_CHECKING:
    from sensorfault.runtime.compared import Comparison
    from sensorfault.runtime.model import Model
    from sensorfault.runtime.result import Detection

WATCHED_SHOWN = 24
SUSPECTS_SHOWN = 10
NAMES_SHOWN = 8


def of_detection(detection: "Detection") -> tuple[str, ...]:
    """The limits of the model that judged a log."""
    if detection.coverage is not None:
        return of_coverage(detection)
    assert detection.model is not None
    if detection.fitted_on_s is not None:
        return of_own_model(detection.model, *detection.fitted_on_s)
    return of_model(detection.model)


def of_unjudged(detection: "Detection") -> str:
    """What is said in the place of "none" where no row could be judged."""
    return (
        f"Faults in {detection.log.name}: unknown, as none of its {detection.rows} rows could be judged; it is too "
        "short to judge, or its sensors have no values."
    )


def of_coverage(detection: "Detection") -> tuple[str, ...]:
    """What the default compared, and what it did not and why; nothing for other methods."""
    coverage = detection.coverage
    if coverage is None:
        return ()
    compared = ", ".join(coverage.compared)
    said = [f"Compared with each other: {compared}." if compared else "Nothing could be compared."]
    by_reason: dict[str, list[str]] = {}
    for name, reason in coverage.not_compared.items():
        by_reason.setdefault(reason, []).append(name)
    said += [f"Not compared: {_some(names)} ({reason})." for reason, names in by_reason.items()]
    if coverage.alone:
        said.append(f"Checked alone, for spikes, repeats, silence and absurd values: {_some(list(coverage.alone))}.")
    return (*said, *coverage.sentences)


def of_comparison(comparison: "Comparison") -> tuple[str, ...]:
    """How many comparisons were fitted, on what, and what is known of their false alarms."""
    learned, summary = comparison.learned, comparison.summary
    assert learned is not None
    count = len({key.rpartition(" over ")[0] for key in learned.limit})
    return (
        f"Fitted {count} comparisons of sensors of a {summary['vehicle']} on {clock(summary['training_s'])}.",
        "One log promises no false-alarm rate; its limits are the largest differences seen, with a margin.",
    )


def _some(names: list[str]) -> str:
    more = f" and {len(names) - NAMES_SHOWN} more" if len(names) > NAMES_SHOWN else ""
    return f"{', '.join(names[:NAMES_SHOWN])}{more}"


def of_own_model(model: "Model", start_s: float, end_s: float) -> tuple[str, ...]:
    """The limits of a model that was fitted on the beginning of the log it judges, from `start_s` to `end_s`."""
    return (
        f"No model was given: {model.method} was fitted on {clock(start_s)} to {clock(end_s)} of this log, "
        "which is assumed healthy; only the rest was checked.",
        "Faults in that part cannot be found, and the false-alarm rate is unknown; "
        "to change both, fit a model on a drive you trust with 'sensorfault fit'.",
        *suspects(model),
        *not_watched(model),
    )


def of_model(model: "Model") -> tuple[str, ...]:
    """The limits of a model from a file."""
    fitted = f"Limits: fitted by {model.method} on {model.summary.get('training_log', 'another log')}."
    return (fitted, *rate(model), *not_watched(model))


def rate(model: "Model") -> tuple[str, ...]:
    """What is known of the false-alarm rate."""
    known = model.summary
    if "alarms_per_hour" not in known:
        return ("False-alarm rate: not measured.",)
    return (f"False alarms on the part held out: {alarms(known['held_out_alarms'], known['held_out_s'])}.",)


def alarms(count: int, seconds: float) -> str:
    """What `count` false alarms in some seconds of healthy data say of their rate."""
    from sensorfault.numerics.poisson import rate_below

    hours = seconds / 3600
    below = f"fewer than {rate_below(count, hours):.3g} an hour with 95 % confidence"
    if count:
        return f"{count} in {_duration(seconds)}, {count / hours:.3g} an hour ({below})" if hours else str(count)
    if hours < 1:
        return f"none in {_duration(seconds)}: too short to promise a rate"
    return f"none in {_duration(seconds)}: {below}"


def _duration(seconds: float) -> str:
    if seconds < 120:
        return f"{seconds:.0f} s"
    return f"{seconds / 60:.1f} min" if seconds < 7200 else f"{seconds / 3600:.1f} h"


def watches(paths: list[str]) -> str:
    """The channels that are watched; of very many the first."""
    return f"Watches {some(paths)}."


def some(paths: Sequence[str]) -> str:
    """The paths; of very many the first."""
    many = f" and {len(paths) - WATCHED_SHOWN} more" if len(paths) > WATCHED_SHOWN else ""
    return f"{', '.join(paths[:WATCHED_SHOWN])}{many}"


def smallest(model: "Model") -> tuple[str, ...]:
    """The smallest step that the model can find, and the method's warning, where the method knows them."""
    steps: Mapping[str, float] = model.summary.get("smallest_step_m", {})
    if not steps:
        return ()
    sizes = ", ".join(f"{size:.1f} m {when}" for when, size in steps.items())
    warning = model.summary.get("inert")
    return (f"Smallest step found nine times out of ten: {sizes}.", *([warning] if warning else []))


def suspects(model: "Model") -> tuple[str, ...]:
    """The training data that were left out of the fit because they look faulty."""
    found: list[dict[str, Any]] = model.summary.get("training_suspects", [])
    if not found:
        return ()
    spans = "; ".join(
        f"{one['reason']} on {one['channel']}, {clock(one['start_s'])} to {clock(one['end_s'])}"
        for one in found[:SUSPECTS_SHOWN]
    )
    more = f" and {len(found) - SUSPECTS_SHOWN} more" if len(found) > SUSPECTS_SHOWN else ""
    return (f"Left out of the fit because it looks faulty: {spans}{more}.",)


def not_watched(model: "Model") -> tuple[str, ...]:
    """Parts of the method that this log does not allow; channels that are checked for dropouts only; and why."""
    parts: dict[str, str] = model.summary.get("cannot", {})
    missing = tuple(f"Not running {part}: {reason}" for part, reason in parts.items())
    return (*missing, *dropouts_only(model.summary.get("not_watched", {})))


def dropouts_only(reasons: Mapping[str, str]) -> tuple[str, ...]:
    """The channels that are checked for dropouts only, and why."""
    if not reasons:
        return ()
    by_reason: dict[str, list[str]] = {}
    for path, reason in reasons.items():
        by_reason.setdefault(reason, []).append(path)
    silent = "; ".join(f"{', '.join(paths)} ({reason})" for reason, paths in by_reason.items())
    return (f"Checked for dropouts only: {silent}.",)
