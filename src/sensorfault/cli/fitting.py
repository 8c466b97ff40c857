"""Find the model that judges a log: load it, or fit it on the log's beginning."""

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from sensorfault.cli import limits, show

if TYPE_CHECKING:
    from sensorfault.logs import Log
    from sensorfault.logs.vehicle import VehicleFile
    from sensorfault.runtime.compared import Comparison
    from sensorfault.runtime.model import Model
    from sensorfault.runtime.streaming import Fit


INERTIAL = "relative-conditioning"  # for logs in which no two sensors measure the same


@dataclass(frozen=True)
class Choice:
    """What the user chose: a model file; or a method, and the share of the log to fit it on. No method: auto.

    Raises:
        LogError: the share is not one, or no method has that name.
    """

    path: Path | None
    method: str | None
    learn: float
    seed: int

    def __post_init__(self) -> None:
        from sensorfault.logs import LogError

        if not 0.05 <= self.learn <= 0.95:  # click accepts NaN as a number
            raise LogError(f"--learn is {self.learn:g}; give the share of the log to fit on, 0.05 to 0.95.")
        from sensorfault.runtime.names import is_default, recipe_of

        if not is_default(self.method):
            from sensorfault.methods.catalog import recipe

            recipe(recipe_of(str(self.method)))


def known_by(choice: Choice) -> "VehicleFile | None":
    """What the chosen model knows of the columns of a log; None without a model."""
    from sensorfault.runtime.saved import known_in

    return known_in(choice.path) if choice.path is not None else None


def comparison_of(choice: Choice) -> "Comparison | None":
    """The comparison to judge with, if that is what the user chose; None if it is another method.

    Raises:
        LogError: a model of another method than the one asked for.
    """
    from sensorfault.logs import LogError
    from sensorfault.relations.events import METHOD
    from sensorfault.relations.vehicle_class import FLYING, class_named
    from sensorfault.runtime.compared import Comparison
    from sensorfault.runtime.names import is_default, vehicle_of
    from sensorfault.runtime.saved import method_of, read_comparison

    if choice.path is None:
        return Comparison(vehicle=vehicle_of(choice.method)) if is_default(choice.method) else None
    method = method_of(choice.path)
    if choice.method not in (None, method) and not (method == METHOD and is_default(choice.method)):
        raise LogError(f"{choice.path} is a model of {method}, not of {choice.method}; leave out --method, or --model.")
    if method != METHOD:
        return None
    found = read_comparison(choice.path)
    named, own = vehicle_of(choice.method), found.learned.vehicle if found.learned else ""
    if named and class_named(named, {}) != own and (named != "drone" or own not in FLYING):
        raise LogError(f"{choice.path} is a model of a {own}, not of a {named}; leave out --method, or --model.")
    return found


def model_or_fit(choice: Choice) -> "Model | Fit":
    """The stored model, or what fits one on a log.

    Raises:
        LogError: the model is of another method than the one asked for.
    """
    if choice.path is not None:
        return _stored(choice.path, choice.method)

    def fitted(log: "Log") -> "Model":
        from sensorfault.methods.catalog import DEFAULT
        from sensorfault.methods.fit import fit
        from sensorfault.runtime.names import recipe_of

        method = recipe_of(choice.method or DEFAULT)
        with show.progress() as bar:
            task = bar.add_task(f"fitting {method}", total=None)
            model = fit(log, method, held_out=0.0, seed=choice.seed)
            bar.update(task, total=1, completed=1)
        return model

    return fitted


def _stored(path: Path, method: str | None) -> "Model":
    from sensorfault.logs import LogError
    from sensorfault.runtime.compared import Comparison
    from sensorfault.runtime.store import load

    model = load(path)
    if isinstance(model, Comparison):
        raise LogError(f"{path}: a model of {model.method} cannot be evaluated; fit one of another --method.")
    if method is not None and method != model.method:
        raise LogError(f"{path} is a model of {model.method}, not of {method}; leave out --method, or --model.")
    return model


def model_and_rest(choice: Choice, log: "Log") -> "tuple[Model, Log]":
    """The model, and the part of a whole log that it was not fitted on."""
    from sensorfault.runtime.model import Model
    from sensorfault.runtime.streaming import beginning_s

    model = model_or_fit(choice)
    if isinstance(model, Model):
        return model, log
    start_s, cut_s = float(log.time[0]), beginning_s(log, choice.learn)
    model = model(log.between(end_s=cut_s))
    for sentence in limits.of_own_model(model, start_s, cut_s):
        show.say(sentence)
    return model, log.between(cut_s)
