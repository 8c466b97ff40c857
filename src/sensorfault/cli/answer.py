"""The JSON of a detection."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sensorfault.runtime.result import Detection


def of_detection(found: "Detection") -> dict[str, Any]:
    """What `detect` and `report` write with --json."""
    if found.coverage is not None:
        return {**_common(found), **_compared(found)}
    assert found.model is not None
    return {
        **_common(found),
        "watched": [channel.path for channel, w in zip(found.model.channels, found.watched, strict=True) if w],
        "not_watched": found.model.summary.get("not_watched", {}),
    }


def _compared(found: "Detection") -> dict[str, Any]:
    """What was compared with what, and what was not and why."""
    assert found.coverage is not None
    return {"compared": found.coverage.compared, "not_compared": found.coverage.not_compared}


def _common(found: "Detection") -> dict[str, Any]:
    return {
        "log": found.log.name,
        "method": found.method,
        "judged_s": [float(found.log.time[0]), float(found.log.time[-1])],
        "judged": found.judged,
        "fitted_on_s": found.fitted_on_s,
        "notes": list(found.notes),
        "events": [event.as_dict() for event in found.events],
    }
