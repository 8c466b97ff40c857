"""Sensorfault: notices when a vehicle's sensor lies, names it and the kind of fault, and keeps going on what is left.

>>> import sensorfault as sf
>>> log = sf.read("drive.csv")
>>> model = sf.fit(log.between(end_s=120))  # taken as healthy
>>> found = sf.detect(model, log.between(120))
>>> for event in found.events:
...     print(event)
>>> sf.save(model, "car.sensorfault")
>>> live = sf.Live(sf.load("car.sensorfault"))
>>> now = live.push(120.02, values)  # one sample in SI, one verdict
>>> now.sample == sf.FAULT, live.open()
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from sensorfault.core.monitor import Monitor
    from sensorfault.core.types import FAULT, OK, UNKNOWN, VERDICTS
    from sensorfault.evaluation.campaign import campaign
    from sensorfault.evaluation.judge import judge
    from sensorfault.events.event import Event
    from sensorfault.events.export import write_events
    from sensorfault.faults.fault import Fault
    from sensorfault.faults.inject import inject
    from sensorfault.logs import Log, LogError, read, write
    from sensorfault.methods.catalog import METHODS
    from sensorfault.methods.fit import fit
    from sensorfault.report.page import write_page
    from sensorfault.runtime.detect import Live, detect
    from sensorfault.runtime.model import Model
    from sensorfault.runtime.result import Detection
    from sensorfault.runtime.store import load, save
    from sensorfault.simulation.road import drive

# JAX and the readers are slow to import: each name brings its module along when it is first asked for.
_HOME = {
    "FAULT": "core.types",
    "OK": "core.types",
    "UNKNOWN": "core.types",
    "VERDICTS": "core.types",
    "Detection": "runtime.result",
    "Event": "events.event",
    "Fault": "faults.fault",
    "Live": "runtime.detect",
    "Log": "logs",
    "LogError": "logs",
    "METHODS": "methods.catalog",
    "Model": "runtime.model",
    "Monitor": "core.monitor",
    "campaign": "evaluation.campaign",
    "detect": "runtime.detect",
    "drive": "simulation.road",
    "fit": "methods.fit",
    "inject": "faults.inject",
    "judge": "evaluation.judge",
    "load": "runtime.store",
    "read": "logs",
    "save": "runtime.store",
    "write": "logs",
    "write_events": "events.export",
    "write_page": "report.page",
}

__all__ = [
    "FAULT",
    "METHODS",
    "OK",
    "UNKNOWN",
    "VERDICTS",
    "Detection",
    "Event",
    "Fault",
    "Live",
    "Log",
    "LogError",
    "Model",
    "Monitor",
    "campaign",
    "detect",
    "drive",
    "fit",
    "inject",
    "judge",
    "load",
    "read",
    "save",
    "write",
    "write_events",
    "write_page",
]


def __getattr__(name: str) -> Any:
    if name not in _HOME:
        raise AttributeError(f"sensorfault has no '{name}'; it has {', '.join(__all__)}")
    return getattr(import_module(f"sensorfault.{_HOME[name]}"), name)
