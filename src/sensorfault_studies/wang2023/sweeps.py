"""Figures: detection of a fault by each method and the position error during it, by size of the fault."""

from sensorfault_studies.findings import Figure, Json
from sensorfault_studies.numbers import Numbers
from sensorfault_studies.wang2023.contenders import ALONE, CHI_SQUARE, LOF, NONE, OURS
from sensorfault_studies.wang2023.drives import EQUAL, HEAVY

SHOWN = (NONE, CHI_SQUARE, "w-test", "aime-10", LOF, "lof-windows", "cumulative", ALONE, OURS)
AXES = {"step": "step [m]", "ramp": "ramp [m/s]"}
METRICS = {
    "detection_rate": "share of the fault's epochs in which the satellite is flagged",
    "hrmse_m": "RMS horizontal error during the fault [m]",
}


def sweeps(numbers: Numbers) -> tuple[Figure, ...]:
    """The figures for heavy noise, all methods at a common false alarm rate."""
    return tuple(_sweep(numbers, kind, metric) for kind in AXES for metric in METRICS)


def _sweep(numbers: Numbers, kind: str, metric: str) -> Figure:
    words = f"{HEAVY.words} {EQUAL}"
    sizes = [fault.size for fault in HEAVY.faults if fault.kind == kind]
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
        "A real drive with simulated satellites and heavy noise; one false alarm in a hundred epochs for each method."
    )
    return Figure(
        f"c_{kind}_{metric}", f"{AXES[kind].split()[0]}s: {metric}", caption, {"data": data, "layout": layout}
    )
