"""Figures: how much of a fault each method sees, by its size, and how far off the position is meanwhile."""

from sensorfault_studies.findings import Figure, Json
from sensorfault_studies.numbers import Numbers
from sensorfault_studies.wang2023.contenders import ALONE, CHI_SQUARE, LOF, NONE, OURS
from sensorfault_studies.wang2023.drives import EQUAL, HEAVY

SHOWN = (NONE, CHI_SQUARE, "w-test", "aime-10", LOF, "lof-windows", "cumulative", ALONE, OURS)
AXES = {"step": "step [m]", "ramp": "ramp [m/s]"}
METRICS = {
    "detection_rate": "share of the fault's epochs in which the satellite is flagged",
    "hrmse_m": "horizontal error in the fault, rms [m]",
}


def sweeps(numbers: Numbers) -> tuple[Figure, ...]:
    """Of heavy noise, all methods at one rate of false alarms."""
    return tuple(_sweep(numbers, kind, metric) for kind in AXES for metric in METRICS)


def _sweep(numbers: Numbers, kind: str, metric: str) -> Figure:
    words = f"{HEAVY.words} {EQUAL}"
    sizes = [lie.size for lie in HEAVY.lies if lie.kind == kind]
    data: list[Json] = []
    for method in SHOWN:
        y = [numbers.mean(words, method, metric, kind, size) for size in sizes]
        known = [(size, round(value, 4)) for size, value in zip(sizes, y, strict=True) if value == value]
        if known:
            x, y = (list(column) for column in zip(*known, strict=True))
            data.append({"type": "scatter", "mode": "lines+markers", "name": method, "x": x, "y": y})
    layout: Json = {
        "xaxis": {"title": {"text": AXES[kind]}, "type": "log"},
        "yaxis": {"title": {"text": METRICS[metric]}},
    }
    caption = (
        "A real drive under simulated satellites, heavy noise; one false alarm in a hundred epochs for each method."
    )
    return Figure(
        f"c_{kind}_{metric}", f"{AXES[kind].split()[0]}s: {metric}", caption, {"data": data, "layout": layout}
    )
