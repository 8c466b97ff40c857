"""Figures of slow drifts: delays, one flight, and the length of the window."""

import numpy as np
from jaxtyping import Float

from sensorfault.methods.height import drift_setting, slope
from sensorfault_studies.findings import Figure, Json
from sensorfault_studies.multistep.slow import Slow
from sensorfault_studies.multistep.slow_judge import RATES

_SLOWEST = 0  # of RATES


def figures(result: Slow) -> tuple[Figure, ...]:
    """The figures of one flight."""
    return (_delays(result), _flight(result), *_windows(result))


def _delays(result: Slow) -> Figure:
    data: list[Json] = [
        {
            "type": "scatter",
            "mode": "lines+markers",
            "name": method,
            "x": list(RATES),
            "y": [round(float(d), 1) for d in one.delay.mean(axis=1)],
        }
        for (method, variant), one in result.result.items()
        if not variant
    ]
    layout: Json = {
        "xaxis": {"title": {"text": "ramp [m/s]"}, "type": "log"},
        "yaxis": {"title": {"text": "mean delay [s]"}, "type": "log"},
    }
    caption = (
        "Ramps in the second half of the flight, limits from the first half. The table has the false alarms of each "
        "test without a ramp."
    )
    return Figure(
        f"d_slow_delay_{result.data}", f"Delay of slow ramps, {result.data}", caption, {"data": data, "layout": layout}
    )


def _flight(result: Slow) -> Figure:
    one = result.result[slope.NAME, ""]
    data = [
        _line("with a ramp of 0.1 m/s", one.time, one.ramped),
        _line("without a ramp", one.time, one.score),
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
    window = f"{drift_setting.DEFAULT.window_s:g} s"
    caption = (
        f"Slope of receiver minus barometer over {window}; the limit comes from the first half of the flight, the ramp "
        "begins at the dashed line."
    )
    return Figure(
        f"d_slow_score_{result.data}",
        f"Slope of the difference, {result.data}",
        caption,
        {"data": data, "layout": layout},
    )


def _windows(result: Slow) -> tuple[Figure, ...]:
    if not result.windows:
        return ()
    data: list[Json] = []
    for i, (method, sweep) in enumerate(result.windows.items()):
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
        "Longer windows detect slower ramps, until the first half of a flight contains too few windows. Below: largest "
        "healthy score of the second half divided by that of the first; there are false events above "
        f"{drift_setting.DEFAULT.margin:g}."
    )
    return (
        Figure(
            f"d_slow_window_{result.data}",
            f"Length of the window, {result.data}",
            caption,
            {"data": data, "layout": layout},
        ),
    )


def _line(name: str, x: Float[np.ndarray, " n"], y: Float[np.ndarray, " n"]) -> Json:
    shown = [round(float(v), 5) if np.isfinite(v) else None for v in y]
    return {"type": "scatter", "mode": "lines", "name": name, "x": [round(float(v), 2) for v in x], "y": shown}
