"""Figures 6, 7 and 8 of the paper: training loss, a slow ramp, and the number of steps."""

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from sensorfault_studies.findings import Figure, Json
from sensorfault_studies.multistep.contenders import KINEMATIC, NETWORK
from sensorfault_studies.multistep.drift import HARD, PRINTED, Drift, Surface

LEARNED = (1, 5, 10, 15)  # numbers of steps whose training is shown
SHOWN = ((NETWORK, PRINTED), (NETWORK, HARD), (KINEMATIC, HARD))
SLOW = 0.1  # the ramp of figure 7 [m/s]


def of_drift(result: Drift) -> tuple[Figure, ...]:
    """The figures of one flight."""
    shown = [_sweep(result.data, *key, result.surfaces[key]) for key in SHOWN if key in result.surfaces]
    return (*_training(result), *(_residual(result, n) for n in (1, 10)), *shown)


def _training(result: Drift) -> tuple[Figure, ...]:
    """The paper's figure 6."""
    data: list[Json] = []
    for contender in result.contenders:
        if contender.trained is None or contender.variant:
            continue
        for m, n in enumerate(contender.steps[: len(contender.steps) // contender.seeds]):
            loss = contender.trained.loss[0, m]
            if n in LEARNED:
                data.append(_line(f"N = {n}", loss[np.isfinite(loss)], start=1))
    layout: Json = {
        "xaxis": {"title": {"text": "epoch"}},
        "yaxis": {"title": {"text": "loss [squared spreads of an increment]"}, "type": "log"},
    }
    caption = (
        "The paper's figure 6: each training ends after ten epochs without a lower loss; the paper's training ended "
        "after 294 epochs."
    )
    figure = Figure(
        f"d_training_{result.data}", f"Training loss, {result.data}", caption, {"data": data, "layout": layout}
    )
    return (figure,)


def _residual(result: Drift, steps: int) -> Figure:
    """The paper's figure 7: the slowest ramp at its first onset, with the threshold of the paper."""
    (contender,) = [c for c in result.contenders if c.trained and not c.variant]
    assert result.printed is not None
    assert result.ramps is not None
    (cell, *_) = np.flatnonzero(result.ramps.slope == SLOW)
    onset, k = int(result.ramps.onset[cell]), contender.of(steps)[0]
    data = [
        _line("|residual|", result.printed.score[k, cell]),
        _line("|residual| without the ramp", result.printed.score[k, 0]) | {"line": {"width": 1}, "opacity": 0.5},
        _line("threshold", result.printed.limit[k, cell]) | {"line": {"dash": "dot"}},
    ]
    mark: Json = {"type": "line", "x0": onset, "x1": onset, "yref": "paper", "y0": 0, "y1": 1, "line": {"dash": "dash"}}
    layout: Json = {
        "xaxis": {"title": {"text": "step of the test part"}},
        "yaxis": {"title": {"text": "[m]"}},
        "shapes": [mark],
    }
    late = result.printed.alarm[k, cell, onset:]
    found = f"{int(np.argmax(late))} steps later" if late.any() else "never"
    caption = (
        f"The paper's figure 7 with a = b = 1: a ramp of {SLOW} m/s begins at the dashed line; the first alarm "
        f"comes {found}. Thin: the same flight without the ramp. The paper's ramp begins at step 500, with alarms at "
        "883 with N = 1 and at 580 with N = 10."
    )
    title = f"Residual and threshold, N = {steps}, {result.data}"
    return Figure(f"d_residual_n{steps}_{result.data}", title, caption, {"data": data, "layout": layout})


def _sweep(data: str, method: str, condition: str, surface: Surface) -> Figure:
    """The paper's figure 8 and table 2: first alarm and share of alarms over the number of steps, by slope."""
    lines: list[Json] = []
    for axis, value in (("", surface.rate), ("2", surface.delay)):
        for i, slope in enumerate(surface.slopes):
            shade = f"hsl({round(240 - 240 * i / max(len(surface.slopes) - 1, 1))}, 70%, 45%)"
            line = {
                "type": "scatter",
                "mode": "lines",
                "name": f"{slope:g} m/s",
                "legendgroup": f"{slope:g}",
                "showlegend": not axis,
                "x": list(surface.steps),
                "y": [round(float(v), 4) for v in value[:, i]],
                "yaxis": f"y{axis}",
                "line": {"color": shade},
            }
            lines.append(line)
    layout: Json = {
        "xaxis": {"title": {"text": "steps N"}, "anchor": "y2"},
        "yaxis": {"title": {"text": "share of steps with alarm"}, "domain": [0.55, 1.0], "range": [0, 1.02]},
        "yaxis2": {"title": {"text": "steps to the alarm"}, "domain": [0.0, 0.45]},
        "height": 560,
    }
    words = "with the paper's threshold" if condition == PRINTED else "with limits that 1 % of healthy steps exceed"
    caption = (
        f"The paper's figure 8 and table 2, {words}: share of the faulty steps with an alarm, and steps from the onset "
        "to the first alarm (the whole ramp if there is none). The table has the numbers without a ramp."
    )
    title = f"{method}, {condition}, {data}"
    return Figure(f"d_sweep_{method}_{condition}_{data}", title, caption, {"data": lines, "layout": layout})


def _line(name: str, y: Float[np.ndarray, " T"], start: int = 0) -> Json:
    shown: Sequence[float | None] = [round(float(v), 5) if np.isfinite(v) else None for v in y]
    return {"type": "scatter", "mode": "lines", "name": name, "x": list(range(start, start + len(y))), "y": shown}
