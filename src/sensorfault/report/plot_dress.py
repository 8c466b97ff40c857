"""A figure of the report page for Plotly in Python: colours and arrays put in, as page.js does it in a browser."""

import re
from base64 import b64decode
from functools import cache
from importlib.resources import files
from typing import Any

import numpy as np

from sensorfault.report.page_figure import Json

_MARGIN = {"l": 78, "r": 10, "t": 10, "b": 34}
_CLEAR = "rgba(0,0,0,0)"


def dress(figure: Json, dark: bool) -> Json:
    """The same figure with the page's colours, its arrays as numbers, and a transparent background."""
    colors = palette(dark)
    made: Json = _filled(figure, colors)
    label = {"bgcolor": colors["back"], "bordercolor": colors["rule"], "font": {"color": colors["text"], "size": 12}}
    for note in made["layout"]["annotations"]:
        note["font"] = {"color": colors["text"], "size": 12}
    made["layout"] |= {
        "paper_bgcolor": _CLEAR,
        "plot_bgcolor": _CLEAR,
        "template": "none",
        "showlegend": False,
        "margin": _MARGIN,
        "font": {"size": 11, "color": colors["muted"]},
        "hoverlabel": label,
    }
    return made


@cache
def palette(dark: bool) -> dict[str, str]:
    """The colours of the style sheet by name, without dashes."""
    style = files("sensorfault.report").joinpath("page.css").read_text("utf-8")
    light, night = style.split("@media (prefers-color-scheme: dark)")[:2]
    pairs = re.findall(r"--(\w+): ([^;]+);", light + night[: night.index("}")] if dark else light)
    return dict(pairs)


def _filled(part: Any, colors: dict[str, str]) -> Any:
    match part:
        case {"f4": str(packed), "from": base}:
            return np.frombuffer(b64decode(packed), "<f4").astype(float) + base
        case dict():
            return {key: _filled(value, colors) for key, value in part.items()}
        case list() | tuple():
            return [_filled(value, colors) for value in part]
        case str() if part.startswith("--") and part[2:] in colors:
            return colors[part[2:]]
        case _:
            return part
