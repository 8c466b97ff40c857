"""Figures of A2: the score over time around a frozen position, and F1 over the length of the fault."""

from collections.abc import Sequence

import numpy as np

from sensorfault.runtime.model import Model
from sensorfault_studies.findings import Figure, Json, Row
from sensorfault_studies.min2021.jam_scores import scored
from sensorfault_studies.min2021.jamming import Drive, jammed

SHOWN_S = 5.0  # length of the fault that is shown [s]
AROUND_S = 10.0  # time shown before and after it [s]


def figures(rows: Sequence[Row], lines: Sequence[tuple[Drive, dict[str, Model]]]) -> tuple[Figure, ...]:
    """Both figures for each drive."""
    return tuple(figure for drive, models in lines for figure in (_over_time(drive, models), _by_length(drive, rows)))


def _over_time(drive: Drive, models: dict[str, Model]) -> Figure:
    copy = jammed(drive, SHOWN_S, 0)
    onset = copy.onsets[len(copy.onsets) // 2]
    time = drive.rest.time[drive.fixes]
    near = (time > onset - AROUND_S) & (time < onset + SHOWN_S + AROUND_S)
    data: list[Json] = []
    for name, model in models.items():
        one = scored(model, copy.log, drive.fixes, drive.position, lambda test: not test.startswith("slip"))
        score = np.maximum(one.score[near], 1e-3).round(4).tolist()
        data.append({"type": "scatter", "mode": "lines", "name": name, "x": (time[near] - onset).tolist(), "y": score})
    layout = {
        "xaxis": {"title": {"text": "time since the position froze [s]"}},
        "yaxis": {"title": {"text": "score / limit"}, "type": "log"},
        "shapes": [
            {"type": "rect", "x0": 0, "x1": SHOWN_S, "y0": 0, "y1": 1, "yref": "paper", "fillcolor": "gray",
             "opacity": 0.15, "line": {"width": 0}},
            {"type": "line", "xref": "paper", "x0": 0, "x1": 1, "y0": 1, "y1": 1, "line": {"dash": "dot"}},
        ],
    }  # fmt: skip
    caption = (
        "Score divided by limit at every new position around a frozen position of five seconds (grey); above 1: alarm."
    )
    return Figure(f"jam_{drive.name}", f"A frozen position, {drive.name}", caption, {"data": data, "layout": layout})


def _by_length(drive: Drive, rows: Sequence[Row]) -> Figure:
    data: list[Json] = []
    mine = [row for row in rows if row.data == drive.name and row.metric == "f1" and row.magnitude is not None]
    kept = ("as-printed", "as-printed no-repeats")
    for method, condition in dict.fromkeys((row.method, row.condition) for row in mine if row.condition in kept):
        of = [row for row in mine if (row.method, row.condition) == (method, condition)]
        name = method + condition.removeprefix("as-printed")
        x, y = [row.magnitude for row in of], [round(row.value, 4) for row in of]
        data.append({"type": "scatter", "mode": "lines+markers", "name": name, "x": x, "y": y})
    layout = {
        "xaxis": {"title": {"text": "length of the fault [s]"}, "type": "log"},
        "yaxis": {"title": {"text": "F1"}, "range": [0, 1.02]},
    }
    caption = "F1 over the length of the fault, each method with its own limit; flag-all: every fix is called frozen."
    return Figure(
        f"jam_f1_{drive.name}", f"F1 of frozen positions, {drive.name}", caption, {"data": data, "layout": layout}
    )
