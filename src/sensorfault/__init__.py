"""Sensorfault: notices when a vehicle's sensor lies, names it and the kind of fault, and keeps going on what is left.

>>> import sensorfault as sf
>>> log = sf.read("drive.csv")
>>> model = sf.fit(log.between(end_s=120))  # taken as healthy
>>> found = sf.detect(model, log.between(120))
>>> for event in found.events:
...     print(event)  # 2:10.00-2:12.98 frozen of gyro.y (peak 149, limit 4)
>>> found.verdicts_table(), found.scores_table()  # polars; pandas=True for pandas
>>> found.plot()  # a plotly figure
>>> sf.save(model, "car.sensorfault")
>>> live = sf.Live(sf.load("car.sensorfault"))
>>> now = live.push(120.02, values)  # one sample in SI, one verdict
>>> now.sample == sf.FAULT, live.open()
"""

import ast as _ast
from importlib import import_module as _import_module
from pathlib import Path as _Path
from typing import Any as _Any

from sensorfault.core import plotting as _plotting


def _homes() -> dict[str, str]:
    """The module of each public name, from the one list that type checkers read, too."""
    stub = _ast.parse(_Path(__file__).with_name("__init__.pyi").read_text("utf-8"))
    lines = [line for line in stub.body if isinstance(line, _ast.ImportFrom)]
    return {alias.asname or alias.name: line.module or "" for line in lines for alias in line.names}


# JAX and the readers are slow to import: each name brings its module along when it is first asked for.
_HOMES = _homes()
__all__ = sorted(_HOMES)


def __getattr__(name: str) -> _Any:
    if name == "__version__":
        return _version()
    if name not in _HOMES:
        raise AttributeError(f"sensorfault has no '{name}'; it has {', '.join(__all__)}")
    return getattr(_import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    return [*__all__, *(name for name in (*globals(), "__version__") if name.startswith("__"))]


def _version() -> str:
    from importlib.metadata import version

    return version("sensorfault")


_plotting.draw_with(lambda result, **options: __getattr__("plot")(result, **options))  # `Detection.plot()`
