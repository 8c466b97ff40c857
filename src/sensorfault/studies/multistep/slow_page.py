"""What the study of slow drifts shows: figures and sentences."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from sensorfault.methods import drifting, ramp_glr, slope
from sensorfault.studies.findings import Effort, Figure, Findings, Json
from sensorfault.studies.multistep.slow import EVERY_S, LEAST_S, PLAIN, RATES, SHORT, Slow, Told, slow

_SLOWEST = 0  # of RATES


def findings(effort: Effort) -> Findings:
    """All of D-slow.

    Raises:
        LogError: the real data are not there.
    """
    told = slow(effort)
    rows = tuple(row for one in told for row in one.rows())
    figures = tuple(figure for one in told for figure in (_delays(one), _flight(one), *_windows(one)))
    return Findings(rows, figures, remarks(told))


def _delays(told: Slow) -> Figure:
    data: list[Json] = [
        {
            "type": "scatter",
            "mode": "lines+markers",
            "name": method,
            "x": list(RATES),
            "y": [round(float(d), 1) for d in one.delay.mean(axis=1)],
        }
        for (method, variant), one in told.told.items()
        if not variant
    ]
    layout: Json = {
        "xaxis": {"title": {"text": "ramp [m/s]"}, "type": "log"},
        "yaxis": {"title": {"text": "mean delay [s]"}, "type": "log"},
    }
    caption = (
        "Ramps in the second half of the flight, limits from the first; how often each test is wrong without a ramp "
        "stands in the table."
    )
    return Figure(
        f"d_slow_delay_{told.data}", f"Delay of slow ramps, {told.data}", caption, {"data": data, "layout": layout}
    )


def _flight(told: Slow) -> Figure:
    one = told.told[slope.NAME, ""]
    data = [
        _line("with a ramp of 0.1 m/s", one.time, one.ramped),
        _line("as flown", one.time, one.score),
        _line("limit", one.time, np.full(len(one.time), one.limit)) | {"line": {"dash": "dot"}},
    ]
    mark: Json = {
        "type": "line",
        "x0": one.onset_s,
        "x1": one.onset_s,
        "yref": "paper",
        "y0": 0,
        "y1": 1,
        "line": {"dash": "dash"},
    }
    layout: Json = {
        "xaxis": {"title": {"text": "time [s]"}},
        "yaxis": {"title": {"text": "|slope| [m/s]"}},
        "shapes": [mark],
    }
    window = f"{drifting.DEFAULT.window_s:g} s"
    caption = (
        f"Slope of receiver minus barometer over {window}; the limit comes from the first half of the flight, the ramp "
        "begins at the dashed line."
    )
    return Figure(
        f"d_slow_score_{told.data}", f"Slope of the difference, {told.data}", caption, {"data": data, "layout": layout}
    )


def _windows(told: Slow) -> tuple[Figure, ...]:
    if not told.windows:
        return ()
    data: list[Json] = []
    for i, (method, sweep) in enumerate(told.windows.items()):
        delay = np.array([one.delay[_SLOWEST].mean() for one in sweep.values()])
        ratio = np.array([one.ratio for one in sweep.values()])
        for axis, value in (("", delay), ("2", ratio)):
            shown: Json = {"yaxis": f"y{axis}", "legendgroup": method, "showlegend": not axis}
            shown |= {"line": {"color": f"hsl({120 * i}, 60%, 40%)"}}
            data.append(_line(method, np.array(list(sweep)), value) | shown)
    layout: Json = {
        "xaxis": {"title": {"text": "window [s]"}, "anchor": "y2"},
        "yaxis": {"title": {"text": "delay at 0.1 m/s [s]"}, "domain": [0.55, 1.0], "rangemode": "tozero"},
        "yaxis2": {"title": {"text": "healthy: 2nd half / 1st"}, "domain": [0.0, 0.45], "rangemode": "tozero"},
        "height": 520,
    }
    caption = (
        "Longer windows find slower ramps until the first half of a flight shows too few of them: below, the largest "
        f"healthy score of the second half over that of the first, and above {drifting.DEFAULT.margin:g} false events."
    )
    return (
        Figure(
            f"d_slow_window_{told.data}",
            f"How long to look back, {told.data}",
            caption,
            {"data": data, "layout": layout},
        ),
    )


def _line(name: str, x: Float[np.ndarray, " n"], y: Float[np.ndarray, " n"]) -> Json:
    shown = [round(float(v), 5) if np.isfinite(v) else None for v in y]
    return {"type": "scatter", "mode": "lines", "name": name, "x": [round(float(v), 2) for v in x], "y": shown}


def remarks(told: Sequence[Slow]) -> tuple[str, ...]:
    """What the numbers do not say by themselves."""
    return (_reading(), *(_found(one) for one in told), *_swept(told))


def _reading() -> str:
    setting = drifting.DEFAULT
    return (
        f"D-slow: at {1 / setting.beat_s:g} Hz, receiver minus barometer, both averaged over a beat and brought to one "
        f"moment by the barometer's own speed. Limits are {setting.margin:g} times the largest healthy score of the "
        f"first half of the flight; ramps begin every {EVERY_S:g} s of the second half until {LEAST_S:g} s before its "
        "end; a ramp that is not found counts with the time to the end of the flight, and so does chance_delay_s, the "
        "first alarm without a ramp. whole-flight: limits from the whole flight, as in the prototype, so that no test "
        f"has a false event. {SHORT}: windows of 60 s; {PLAIN}: both heights taken to show the same moment. No test "
        "listens to the receiver's vertical speed, so height-and-vd repeats height."
    )


def _found(told: Slow) -> str:
    said = []
    for method in (slope.NAME, ramp_glr.NAME):
        one = told.told[method, ""]
        said.append(f"{method} finds 0.1, 0.3 and 1 m/s after {_times(one)} with {one.false} false events")
    return (
        f"D-slow, {told.data}: {'; '.join(said)}. The barometer is presumed healthy: the difference of two cannot tell "
        "who drifts."
    )


def _swept(told: Sequence[Slow]) -> tuple[str, ...]:
    if not told[0].windows:
        return ()
    clean = [{w for w, one in each.windows[slope.NAME].items() if one.false == 0} for each in told]
    windows = ", ".join(f"{w:g}" for w in sorted(set.intersection(*clean)))
    return (
        f"D-slow: the window of {drifting.DEFAULT.window_s:g} s was chosen on these two flights, which are all there "
        f"are; the slope has no false event on either with windows of {windows} s, and longer windows promise delays "
        "that a training flight of five minutes cannot vouch for.",
    )


def _times(one: Told) -> str:
    return " / ".join(f"{d:.0f}" for d in one.delay.mean(axis=1)) + " s"
